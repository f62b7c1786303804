//! `files`: the page's static files. They are part of the program: no installation, build or search path.

#[derive(Clone, Copy, Debug)]
pub(crate) struct File {
    /// Path in the request.
    pub(crate) path: &'static str,
    /// MIME type.
    pub(crate) kind: &'static str,
    pub(crate) text: &'static str,
}

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const PICTURE: &str = "image/svg+xml";

macro_rules! files {
    ($($name:literal: $kind:ident,)*) => {
        /// All files of the page.
        pub(crate) const FILES: &[File] = &[
            $(File { path: concat!("/", $name), kind: $kind, text: include_str!(concat!("../web/", $name)) },)*
        ];
    };
}

files! {
    "index.html": HTML,
    "page.css": STYLE,
    "icon.svg": PICTURE,
    "main.js": SCRIPT,
    "link.js": SCRIPT,
    "store.js": SCRIPT,
    "colours.js": SCRIPT,
    "camera.js": SCRIPT,
    "field.js": SCRIPT,
    "remote.js": SCRIPT,
    "robots.js": SCRIPT,
    "shapes.js": SCRIPT,
    "heat.js": SCRIPT,
    "words.js": SCRIPT,
    "layers.js": SCRIPT,
    "signs.js": SCRIPT,
    "drag.js": SCRIPT,
    "why.js": SCRIPT,
    "explain.js": SCRIPT,
    "timeline.js": SCRIPT,
    "match.js": SCRIPT,
    "health.js": SCRIPT,
    "spectrum.js": SCRIPT,
    "plots.js": SCRIPT,
    "playon.js": SCRIPT,
    "plot.js": SCRIPT,
    "axes.js": SCRIPT,
    "course.js": SCRIPT,
    "log.js": SCRIPT,
    "control.js": SCRIPT,
    "snapshots.js": SCRIPT,
    "skills.js": SCRIPT,
    "tune.js": SCRIPT,
    "kicks.js": SCRIPT,
    "hand.js": SCRIPT,
    "transport.js": SCRIPT,
    "keys.js": SCRIPT,
    "bench.js": SCRIPT,
    "cases.js": SCRIPT,
    "dom.js": SCRIPT,
    "put.js": SCRIPT,
    "over.js": SCRIPT,
    "workbench.js": SCRIPT,
    "ghost.js": SCRIPT,
    "draft.js": SCRIPT,
    "judge.js": SCRIPT,
    "rehearse.js": SCRIPT,
    "evidence.js": SCRIPT,
}

/// The file with this path; `/` is the page itself.
pub(crate) fn find(path: &str) -> Option<&'static File> {
    let path = if path == "/" { "/index.html" } else { path };
    FILES.iter().find(|file| file.path == path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_module_that_is_imported_is_there() {
        for file in FILES.iter().filter(|file| file.kind == SCRIPT) {
            for line in file.text.lines().filter(|line| line.starts_with("import")) {
                let name = line.split('"').nth(1).and_then(|name| name.strip_prefix("./"));
                let name = name.unwrap_or_else(|| panic!("{}: {line}", file.path));
                assert!(find(&format!("/{name}")).is_some(), "{}: {line}", file.path);
            }
        }
    }

    #[test]
    fn the_page_loads_nothing_from_elsewhere() {
        for file in FILES {
            let loads = ["src=\"http", "href=\"http", "from \"http", "url(http", "import(\"http"];
            assert!(!loads.iter().any(|label| file.text.contains(label)), "{}", file.path);
        }
    }

    #[test]
    fn no_file_of_the_page_is_longer_than_a_reader_holds_in_mind() {
        for file in FILES {
            let lines = file.text.lines().count();
            assert!(lines <= 300, "{}: {lines} lines; split it", file.path);
        }
    }
}
