//! What the command line asks for.

/// Which functions, and how much of them.
pub(crate) struct Request {
    /// By name; none for all.
    pub(crate) functions: Vec<String>,
    /// Of the floats, one in so many.
    pub(crate) stride: u32,
    /// Adversarial points a function.
    pub(crate) points: usize,
    pub(crate) threads: usize,
}

impl Request {
    /// Reads what follows the mode.
    ///
    /// # Errors
    /// If an option is unknown or lacks its number.
    pub(crate) fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut request = Self { functions: Vec::new(), stride: 1, points: 2000, threads: 1 };
        while let Some(argument) = arguments.next() {
            let mut number = || {
                let text = arguments.next().ok_or(format!("{argument} needs a number"))?;
                match text.parse::<u32>() {
                    Ok(n) if n > 0 => Ok(n),
                    _ => Err(format!("{argument} {text}: a number from 1 to 4294967295 is needed")),
                }
            };
            match argument.as_str() {
                "--stride" => request.stride = number()?,
                "--points" => request.points = number()? as usize,
                "--threads" => request.threads = number()? as usize,
                option if option.starts_with("--") => return Err(format!("no option {option}")),
                _ => request.functions.push(argument),
            }
        }
        Ok(request)
    }
}
