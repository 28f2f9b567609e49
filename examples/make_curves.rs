//! Makes the table of samplers' curves that is shipped with the program; `scripts/make-curves`
//! calls it.
//!
//!     make_curves FILE

use conemosaic::compare::make_table;
use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: make_curves FILE")?;
    let table = make_table(|done, of| {
        let _ = write!(std::io::stderr(), "\r{done} of {of} classes");
    })?;
    std::fs::write(&file, &table)?;
    let _ = writeln!(std::io::stderr(), "\r{file}: {} bytes", table.len());
    Ok(())
}
