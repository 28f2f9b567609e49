//! Tests of the help: its examples are commands that the program understands.

use super::*;

/// Returns the commands of the program and its own help, each with the text below its options.
fn ends_of_help() -> Vec<(String, String)> {
    let text = |command: &clap::Command| {
        let end = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        (command.get_name().to_owned(), end)
    };
    let whole = command();
    std::iter::once(text(&whole)).chain(whole.get_subcommands().map(text)).collect()
}

/// Returns the shell commands in a text; a command over several lines is joined into one.
fn shell_commands(text: &str) -> Vec<String> {
    let joined = text.replace("\\\n", " ");
    let ours = joined.lines().filter_map(|line| line.strip_prefix("  conemosaic "));
    ours.map(|line| format!("conemosaic {line}")).collect()
}

#[test]
fn every_example_in_the_help_is_understood() {
    let mut found = 0;
    for (name, end) in ends_of_help() {
        let examples = end.split_once("Example").map_or("", |(_, examples)| examples);
        let examples = shell_commands(examples);
        assert!(name == "conemosaic" || examples.iter().any(|e| e.contains(&format!(" {name} "))), "{name}");
        for example in examples {
            let words = example.split_whitespace().take_while(|word| *word != ">");
            if let Err(error) = command().try_get_matches_from(words) {
                panic!("{example}\n{error}");
            }
            found += 1;
        }
    }
    assert!(found >= 25, "{found}");
}

#[test]
fn a_command_over_several_lines_is_one() {
    let text = "Example:\n  mkdir a\n  conemosaic run a \\\n    --out b\n  conemosaic paper --out c\n";
    assert_eq!(shell_commands(text), ["conemosaic run a      --out b", "conemosaic paper --out c"]);
}
