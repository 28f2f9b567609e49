//! The help of every command: its tables and examples are shown line by line as they are written in
//! the source.

use std::process::Command;

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

/// Returns the lines of the overview that list the commands.
fn listed() -> Vec<String> {
    let overview = help(None, "--help", NARROWEST);
    let lines = overview.lines().skip_while(|line| *line != "Commands:").skip(1);
    lines.take_while(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// Returns the names of all commands but `help`, which has no help of its own.
fn commands() -> Vec<String> {
    let first = |line: &String| line.split_whitespace().next().unwrap().to_owned();
    listed().iter().map(first).filter(|name| name != "help").collect()
}

/// Returns what follows the last group of options: the tables and examples.
fn end_of_help(help: &str) -> &str {
    let options = &help[help.find("Common options:").unwrap()..];
    let end = options.lines().skip(1).find(|line| !line.is_empty() && !line.starts_with(' ')).unwrap();
    &options[options.find(&format!("\n{end}")).unwrap()..]
}

#[test]
fn tables_and_examples_are_shown_as_written_on_every_terminal() {
    let commands = commands();
    for command in commands.iter().map(|name| Some(name.as_str())).chain([None]) {
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
    let lines = listed();
    assert!(lines.len() >= 12, "{lines:?}");
    for line in lines {
        assert!(line.starts_with("  ") && !line.starts_with("   "), "a command takes two lines: {line}");
    }
}
