use super::Done;
use anyhow::Result;
use clap::Args;
use clap_complete::{Shell, generate};

/// Prints completions for a shell
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic completions bash > ~/.local/share/bash-completion/completions/conemosaic")]
pub struct Completions {
    /// bash, zsh, fish, powershell or elvish
    shell: Shell,
}

impl Completions {
    pub fn execute(self, command: &mut clap::Command) -> Result<Done> {
        let mut text = Vec::new();
        generate(self.shell, command, "conemosaic", &mut text);
        // a reader that stops listening is no error
        let _ = std::io::Write::write_all(&mut std::io::stdout(), &text);
        Ok(Done::Completely)
    }
}
