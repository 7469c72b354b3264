//! Command-line pieces: value parsers, the fluid's flags, one-line errors, the progress bar.

use super::Vec3;
use clap::{Args, Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rapier3d_immersed::Fluid;
use std::fmt::Display;
use std::path::Path;
use std::process::{Command, exit};

/// Parses the command line. A bad value ends the program with exit code 2 and one line that names
/// the flag; `--help` prints and ends it with 0.
pub fn parse<T: Parser>() -> T {
    T::try_parse().unwrap_or_else(|error| {
        if !error.use_stderr() {
            error.exit();
        }
        eprintln!("{}", one_line(&error.to_string()));
        exit(2)
    })
}

/// The paragraph of clap's message that says what is wrong, as one line.
pub fn one_line(message: &str) -> String {
    let lines = message.lines().map(str::trim);
    let paragraph: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    paragraph.join(" ")
}

/// Ends the program because of a bad value: one line that names the flag, exit code 2.
pub fn bad_value(flag: &str, problem: impl Display) -> ! {
    eprintln!("error: {flag}: {problem}");
    exit(2)
}

/// Ends the program because a file could not be written: one line, exit code 1.
pub fn cannot_write(path: &Path, problem: impl Display) -> ! {
    eprintln!("error: cannot write {}: {problem}", path.display());
    exit(1)
}

/// Writes a file, creating its folder, or ends the program.
pub fn write(path: &Path, content: impl AsRef<[u8]>) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    folder
        .map_or(Ok(()), std::fs::create_dir_all)
        .and_then(|()| std::fs::write(path, content))
        .unwrap_or_else(|error| cannot_write(path, error));
}

/// Shows a file in the program that the system opens it with; where that fails, a sentence says so.
pub fn open(path: &Path) {
    let (opener, arguments): (&str, &[&str]) = if cfg!(target_os = "windows") {
        // The first quoted argument of `start` is a window's title.
        ("cmd", &["/C", "start", ""])
    } else if cfg!(target_os = "macos") {
        ("open", &[])
    } else {
        ("xdg-open", &[])
    };
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let outcome = Command::new(opener).args(arguments).arg(&path).status();
    let problem = match outcome {
        Ok(status) if status.success() => return,
        Ok(status) => status.to_string(),
        Err(error) => error.to_string(),
    };
    let path = path.display();
    eprintln!("{opener} could not open {path} ({problem}): open it in a browser");
}

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("must be finite".into()),
        Err(_) => Err("must be a number".into()),
    }
}

/// A finite number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value > 0.0 => Ok(value),
        _ => Err("must be above zero".into()),
    }
}

/// A finite number, zero or above.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        _ => Err("must not be negative".into()),
    }
}

/// `X,Y,Z`, finite.
pub fn vector(text: &str) -> Result<Vec3, String> {
    match text.split(',').map(finite).collect::<Result<Vec<_>, _>>()?[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err("must be three numbers: X,Y,Z".into()),
    }
}

/// A fluid by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FluidName {
    /// 1.184 kg/m³, 1.562e-5 m²/s (25 °C)
    Air,
    /// 997 kg/m³, 0.89e-6 m²/s (25 °C)
    Water,
}

impl FluidName {
    /// The fluid itself.
    pub fn fluid(self) -> Fluid {
        match self {
            Self::Air => Fluid::AIR,
            Self::Water => Fluid::WATER,
        }
    }
}

/// The fluid's flags.
#[derive(Args, Clone, Copy, Debug)]
pub struct FluidArgs {
    /// Fluid that the body is immersed in
    #[arg(long, value_enum, default_value = "air")]
    pub fluid: FluidName,
    /// Density of the fluid, kg/m³, instead of that of --fluid
    #[arg(long, value_name = "KG/M3", value_parser = positive)]
    pub fluid_density: Option<f64>,
    /// Kinematic viscosity of the fluid, m²/s, instead of that of --fluid
    #[arg(long, value_name = "M2/S", value_parser = positive)]
    pub viscosity: Option<f64>,
}

impl FluidArgs {
    /// The fluid that the flags describe; a value that does not fit `f32` ends the program.
    pub fn fluid(&self) -> Fluid {
        let named = self.fluid.fluid();
        let density = self.fluid_density.map_or(named.density(), |x| x as f32);
        let viscosity = self
            .viscosity
            .map_or(named.kinematic_viscosity(), |x| x as f32);
        Fluid::new(density, viscosity)
            .unwrap_or_else(|error| bad_value("--fluid-density/--viscosity", error))
    }
}

/// A progress bar on the terminal's error stream; silent where there is no terminal.
pub fn progress(steps: u64, message: &'static str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(8));
    let style = ProgressStyle::with_template("{msg:24} [{bar:40}] {percent:>3}% {eta_precise}");
    bar.set_style(style.expect("the template is fixed").progress_chars("=> "));
    bar.set_message(message);
    bar
}
