//! Prints the mixed complex of each built-in molecule: cells by kind, and tetrahedra that the skin passes.

use std::collections::BTreeMap;
use std::error::Error;

use zeroset_model::skin::{Skin, benzene, ethanol, water};

fn main() -> Result<(), Box<dyn Error>> {
    for molecule in [water(), ethanol(), benzene()] {
        let cells = Skin::default().cells(&molecule.atoms())?;
        println!("{}: {} atoms, {} cells", molecule.name, molecule.places.len(), cells.len());
        let mut kinds = BTreeMap::<_, [usize; 3]>::new();
        for cell in &cells {
            let counts = kinds.entry(cell.kind).or_default();
            counts[0] += 1;
            counts[1] += cell.tetrahedra.len();
            counts[2] += cell.crossed().count();
        }
        for (kind, [cells, all, kept]) in kinds {
            println!("  {kind:?}: {cells} cells of {all} tetrahedra, {kept} kept");
        }
    }
    Ok(())
}
