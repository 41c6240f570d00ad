//! Molecules from `.xyz` files: the number of atoms, a comment, and a line `symbol x y z` for each.

use std::path::Path;
use std::str::FromStr;

use glam::DVec3;

use super::{Element, Molecule, MoleculeError};

impl Molecule {
    /// Reads an `.xyz` file.
    ///
    /// # Errors
    /// If it cannot be read, or as for its text.
    pub fn read(path: &Path) -> Result<Self, MoleculeError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| MoleculeError::Io { path: path.into(), source })?;
        text.parse()
    }
}

impl FromStr for Molecule {
    type Err = MoleculeError;

    /// From the text of an `.xyz` file. The comment is the name. What follows x, y and z on a line is left
    /// out.
    fn from_str(text: &str) -> Result<Self, MoleculeError> {
        let mut lines = text.lines().enumerate();
        let (_, first) = lines.next().unwrap_or_default();
        let expected = first
            .trim()
            .parse::<usize>()
            .map_err(|_| line_error(1, first, "the number of atoms"))?;
        let name = lines.next().map_or("", |(_, line)| line.trim()).to_owned();
        let places = lines
            .filter(|(_, line)| !line.trim().is_empty())
            .map(|(index, line)| place(index + 1, line))
            .collect::<Result<Vec<_>, _>>()?;
        if places.len() != expected {
            return Err(MoleculeError::Count { found: places.len(), expected });
        }
        Ok(Self { name, places })
    }
}

fn line_error(line: usize, found: &str, expected: &'static str) -> MoleculeError {
    MoleculeError::Line { line, found: found.to_owned(), expected }
}

fn place(line: usize, text: &str) -> Result<(Element, DVec3), MoleculeError> {
    let mut words = text.split_whitespace();
    let symbol = words.next().unwrap_or_default();
    let element = Element::with_symbol(symbol).ok_or_else(|| MoleculeError::Element {
        line,
        symbol: symbol.to_owned(),
        known: Element::ALL.map(|element| element.to_string()).join(" "),
    })?;
    let numbers: Vec<f64> = words.take(3).map_while(|word| word.parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if [x, y, z].iter().all(|x| x.is_finite()) => Ok((element, DVec3::new(x, y, z))),
        _ => Err(line_error(line, text, "a symbol and three finite numbers")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_and_faults_are_named() {
        let text =
            "3\n carbon dioxide, with charges \nC 0 0 0 0.7\n o\t-1.16 0 0 -0.35\nO 1.16 0 0e0\n\n";
        let molecule: Molecule = text.parse().unwrap();
        assert_eq!(molecule.name, "carbon dioxide, with charges");
        assert_eq!(molecule.places[1], (Element::O, DVec3::new(-1.16, 0.0, 0.0)));
        assert_eq!(molecule.atoms()[0].radius, 1.7);
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        assert_eq!(Molecule::read(file.path()).unwrap(), molecule);
        for (text, why) in [
            ("", "line 1: \"\" where there should be the number of atoms"),
            ("H 0 0 0", "line 1: \"H 0 0 0\" where"),
            (
                "1\nlead\nPb 0 0 0",
                "line 3: no radius for element \"Pb\"; there are those of H He C",
            ),
            ("1\n\nH 0 0", "line 3: \"H 0 0\" where"),
            ("1\n\nH 0 0 inf", "three finite numbers"),
            ("2\n\nH 0 0 0", "1 atoms where the first line says 2"),
            ("1\n\nH 0 0 0\nH 1 0 0", "2 atoms where the first line says 1"),
        ] {
            let said = text.parse::<Molecule>().unwrap_err().to_string();
            assert!(said.contains(why), "{said}");
        }
        let said = Molecule::read(Path::new("/nowhere/to/be.xyz")).unwrap_err().to_string();
        assert!(said.starts_with("/nowhere/to/be.xyz: "), "{said}");
    }
}
