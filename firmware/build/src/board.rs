//! `board`: the boards of the workspace, each as its own `Cargo.toml` describes it.
//!
//! A board is a directory of `firmware/boards` whose manifest has a table `[package.metadata.board]`. That
//! directory is the only list: what is built, checked, measured, flashed and documented follows from it.
//! Compiled into the build script as well, which refuses a table that is wrong.

/// A board: the package, and what its firmware is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Board {
    /// Name in options: that of its directory in `firmware/boards`.
    pub name: String,
    /// Name of its package.
    pub package: String,
    /// The chip: as `probe-rs chip list` names it, or the emulated machine.
    pub chip: String,
    /// The target it is built for, a triple.
    pub target: String,
    /// The program with its firmware and where its page goes; `None` for the emulated board, which has
    /// several programs.
    pub firmware: Option<BoardFirmware>,
}

/// The firmware of a real robot's board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardFirmware {
    /// Name of the binary.
    pub image: String,
    /// Names of its other programs, within the same limits: another radio, a base station.
    pub more: Vec<String>,
    /// Largest size of the image in flash, bytes.
    pub flash: u64,
    /// Largest size of RAM taken before the program starts, bytes.
    pub ram: u64,
    /// Address of the page with keys and identity (`protocol::provision`).
    pub page: u32,
}

/// The option for cargo that compiles a package of the firmware as small as it can be.
pub(crate) fn smallest(package: &str) -> [String; 2] {
    ["--config".to_owned(), format!("profile.firmware.package.{package}.opt-level=\"z\"")]
}

impl Board {
    /// The option for cargo with which the package of a real board is compiled: its tasks run once a packet
    /// or less, so it is made as small as it can be, 2 kB less than with "s". What it is flashed with from
    /// its own directory says the same (`.cargo/config.toml`).
    pub fn profile(&self) -> Option<[String; 2]> {
        self.firmware.as_ref().map(|_| smallest(&self.package))
    }

    /// The board of the directory `name`, from the text of its `Cargo.toml`; the error names the key.
    pub fn parse(name: &str, manifest: &str) -> Result<Self, String> {
        let wrong = |what: String| format!("firmware/boards/{name}/Cargo.toml: {what}");
        let table: toml::Table = manifest.parse().map_err(|error| wrong(format!("{error}")))?;
        let package = table.get("package").ok_or_else(|| wrong("no table `[package]`".into()))?;
        let board = package.get("metadata").and_then(|metadata| metadata.get("board"));
        let board = board.ok_or_else(|| wrong("no table `[package.metadata.board]`".into()))?;
        let firmware = match board.get("image") {
            None => None,
            Some(_) => Some(BoardFirmware {
                image: text(board, "image").map_err(wrong)?,
                more: names(board.get("more")).ok_or_else(|| wrong("`more` is no list of names".into()))?,
                flash: number(board, "flash").map_err(wrong)?.into(),
                ram: number(board, "ram").map_err(wrong)?.into(),
                page: number(board, "page").map_err(wrong)?,
            }),
        };
        Ok(Self {
            name: name.to_owned(),
            package: text(package, "name").map_err(wrong)?,
            chip: text(board, "chip").map_err(wrong)?,
            target: text(board, "target").map_err(wrong)?,
            firmware,
        })
    }
}

fn text(table: &toml::Value, key: &str) -> Result<String, String> {
    let value = table.get(key).and_then(toml::Value::as_str);
    value.map(str::to_owned).ok_or_else(|| format!("`{key}` is missing, or no text"))
}

fn number(table: &toml::Value, key: &str) -> Result<u32, String> {
    let value = table.get(key).and_then(toml::Value::as_integer);
    let value = value.and_then(|value| u32::try_from(value).ok());
    value.ok_or_else(|| format!("`{key}` is missing, or no number of 32 bits"))
}

/// A list of texts; an empty one where there is none.
fn names(list: Option<&toml::Value>) -> Option<Vec<String>> {
    let Some(list) = list else { return Some(Vec::new()) };
    list.as_array()?.iter().map(|name| name.as_str().map(str::to_owned)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const REAL: &str = "[package]\nname = \"board-x\"\n[package.metadata.board]\nchip = \"X\"\ntarget = \"t\"\n\
        image = \"onetwo-x\"\nflash = 1024\nram = 512\npage = 0x0800_0000\n";

    #[test]
    fn a_board_is_what_its_manifest_says() {
        let board = Board::parse("x", REAL).unwrap();
        assert_eq!((board.name.as_str(), board.package.as_str()), ("x", "board-x"));
        let firmware = board.firmware.unwrap();
        assert_eq!((firmware.flash, firmware.ram, firmware.page), (1024, 512, 0x0800_0000));
        assert!(firmware.more.is_empty());
        let more = Board::parse("x", &format!("{REAL}more = [\"onetwo-x-base\"]\n")).unwrap();
        assert_eq!(more.firmware.unwrap().more, ["onetwo-x-base"]);
    }

    #[test]
    fn a_table_that_is_wrong_names_the_key_and_the_file() {
        for (from, to, key) in [
            ("chip = \"X\"", "", "`chip`"),
            ("target = \"t\"", "target = 5", "`target`"),
            ("flash = 1024", "flash = -1", "`flash`"),
            ("ram = 512", "ram = 512\nmore = [5]", "`more`"),
            ("page = 0x0800_0000", "page = 0x1_0000_0000", "`page`"),
            ("[package.metadata.board]", "[package.metadata.other]", "`[package.metadata.board]`"),
        ] {
            let error = Board::parse("x", &REAL.replace(from, to)).unwrap_err();
            assert!(error.contains(key) && error.contains("firmware/boards/x/Cargo.toml"), "{error}");
        }
    }
}
