//! The help of every command: its tables and examples are shown line by line as they are written in
//! the source.

use std::process::Command;

/// All commands of the program.
const COMMANDS: [&str; 11] = [
    "run",
    "detect",
    "measure",
    "compare",
    "validate",
    "agree",
    "sample",
    "render",
    "paper",
    "metrics",
    "completions",
];

/// Width, in columns, of the narrowest terminal in which tables and examples must not be wrapped.
const NARROWEST: usize = 80;

/// Returns the help of a command, or of the program, on a terminal of this width.
fn help(command: Option<&str>, option: &str, columns: usize) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_conemosaic"))
        .args(command)
        .arg(option)
        .env("COLUMNS", columns.to_string())
        .output()
        .unwrap();
    assert!(output.status.success(), "{command:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Returns what follows the last group of options: the tables and examples.
fn end_of_help(help: &str) -> &str {
    let options = &help[help.find("Common options:").unwrap()..];
    let end = options.lines().skip(1).find(|line| !line.is_empty() && !line.starts_with(' ')).unwrap();
    &options[options.find(&format!("\n{end}")).unwrap()..]
}

#[test]
fn tables_and_examples_are_shown_as_written_on_every_terminal() {
    for command in COMMANDS.map(Some).into_iter().chain([None]) {
        for option in ["-h", "--help"] {
            let narrow = help(command, option, NARROWEST);
            let end = end_of_help(&narrow);
            assert!(end.contains("\n  conemosaic "), "{command:?}: {end}");
            assert_eq!(end, end_of_help(&help(command, option, 200)), "{command:?}: a line is wrapped");
            for line in end.lines() {
                assert!(line.chars().count() <= NARROWEST, "{command:?}: {line}");
            }
        }
    }
}

#[test]
fn the_overview_lists_every_command_on_one_line() {
    let overview = help(None, "--help", NARROWEST);
    for command in COMMANDS {
        let start = format!("  {command} ");
        let at = overview.lines().position(|line| line.starts_with(&start)).expect(command);
        let next = overview.lines().nth(at + 1).unwrap();
        assert!(next.is_empty() || !next.starts_with("   "), "{command} takes two lines: {next}");
    }
}
