//! Makes the table of the samplers' mean curves that comes with the program. `scripts/make-curves`
//! runs this example.
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
