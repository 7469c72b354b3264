//! Reads which file imports which from the `use` declarations of the source, tests aside.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The files of the source and their imports.
pub struct House {
    /// From file to file, by module paths such as `coupling/step/driver`. Re-exports are looked through:
    /// an import ends at the file that has the item.
    pub imports: BTreeSet<(String, String)>,
    /// Lines of code by room, without unit tests.
    pub lines: BTreeMap<String, usize>,
}

/// A source file without comments and unit tests.
struct Source {
    code: String,
    lines: usize,
}

impl House {
    pub fn read(src: &Path) -> Self {
        let mut sources = BTreeMap::new();
        collect(src, src, &mut sources);
        let tests: Vec<String> = sources.values().flat_map(test_files).collect();
        sources.retain(|name, _| !tests.iter().any(|test| name.ends_with(test.as_str())));
        let reexports = sources
            .iter()
            .flat_map(|(name, source)| declarations(&source.code, true, name, &sources))
            .map(|(from, path)| ((from, path[path.len() - 1].clone()), path))
            .collect::<BTreeMap<_, _>>();
        let mut imports = BTreeSet::new();
        for (name, source) in &sources {
            // The crate root only re-exports.
            if name == "lib" {
                continue;
            }
            for (_, path) in declarations(&source.code, false, name, &sources) {
                if let Some(to) = resolve(&path, &sources, &reexports)
                    && to != *name
                {
                    imports.insert((name.clone(), to));
                }
            }
        }
        let mut lines = BTreeMap::new();
        for (name, source) in &sources {
            if name != "lib" {
                *lines.entry(Self::room(name)).or_default() += source.lines;
            }
        }
        Self { imports, lines }
    }

    /// The room that a file is in: its first folder, or itself.
    pub fn room(file: &str) -> String {
        file.split('/').next().unwrap_or(file).to_owned()
    }

    /// All rooms, in the order of the alphabet.
    pub fn rooms(&self) -> Vec<String> {
        self.lines.keys().cloned().collect()
    }

    /// Files that import each other in a circle, if there are any.
    pub fn circle(&self) -> Option<Vec<String>> {
        let mut done = BTreeSet::new();
        let files: BTreeSet<&String> = self.imports.iter().map(|(from, _)| from).collect();
        files
            .into_iter()
            .find_map(|file| self.circle_from(file, &mut Vec::new(), &mut done))
    }

    fn circle_from(
        &self,
        file: &str,
        path: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        if let Some(start) = path.iter().position(|before| before == file) {
            return Some(path[start..].to_vec());
        }
        if done.contains(file) {
            return None;
        }
        path.push(file.to_owned());
        for (_, to) in self.imports.iter().filter(|(from, _)| from == file) {
            if let Some(circle) = self.circle_from(to, path, done) {
                return Some(circle);
            }
        }
        path.pop();
        done.insert(file.to_owned());
        None
    }
}

fn collect(src: &Path, folder: &Path, sources: &mut BTreeMap<String, Source>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(src, &path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let relative = path.strip_prefix(src).unwrap().with_extension("");
            let parts: Vec<_> = relative.iter().map(|part| part.to_str().unwrap()).collect();
            let name = match parts.split_last() {
                Some((&"mod", folder)) => folder.join("/"),
                _ => parts.join("/"),
            };
            let text = fs::read_to_string(&path).unwrap();
            let code = without_comments(&text);
            let lines = code.lines().filter(|line| !line.trim().is_empty());
            let lines = lines.count();
            let source = Source { code, lines };
            sources.insert(name, source);
        }
    }
}

fn without_comments(text: &str) -> String {
    let lines = text.lines().map(|line| match line.find("//") {
        // A string may contain slashes, a `use` declaration does not.
        Some(at) => &line[..at],
        None => line,
    });
    let code: String = lines.flat_map(|line| [line, "\n"]).collect();
    // Unit tests end a file.
    match code.find("#[cfg(test)]\nmod tests {") {
        Some(at) => code[..at].to_owned(),
        None => match code.find("#[cfg(test)]\npub(crate) mod tests {") {
            Some(at) => code[..at].to_owned(),
            None => code,
        },
    }
}

/// Names of the files that are compiled for tests only.
fn test_files(source: &Source) -> Vec<String> {
    let after = source.code.split("#[cfg(test)]\nmod ").skip(1);
    after
        .filter_map(|rest| rest.split_once(';'))
        .map(|(name, _)| format!("/{}", name.trim()))
        .collect()
}

/// The absolute paths of the `use` declarations of a file, with the file: of those that re-export, or of
/// the others.
fn declarations(
    code: &str,
    reexports: bool,
    file: &str,
    sources: &BTreeMap<String, Source>,
) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    let starts = code.match_indices("use ").filter_map(|(at, _)| {
        // Only what begins a line is a declaration; a string may say "use" too.
        let before = code[..at].rsplit('\n').next().unwrap_or("").trim();
        let public = before.starts_with("pub") && !before.contains(' ');
        (before.is_empty() || public).then_some((at, public))
    });
    for (at, public) in starts {
        let Some((tree, _)) = code[at + 4..].split_once(';') else {
            continue;
        };
        if public != reexports {
            continue;
        }
        let mut paths = Vec::new();
        expand(tree, &mut Vec::new(), &mut paths);
        for path in paths {
            if let Some(path) = absolute(&path, file, sources) {
                found.push((file.to_owned(), path));
            }
        }
    }
    found
}

/// Expands the braces of a `use` tree.
fn expand(tree: &str, prefix: &mut Vec<String>, paths: &mut Vec<Vec<String>>) {
    let tree = tree.trim();
    if let Some(open) = tree.find('{') {
        let parts = tree[..open].split("::").map(str::trim);
        let added: Vec<String> = parts
            .filter(|part| !part.is_empty())
            .map(Into::into)
            .collect();
        let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
        prefix.extend(added.iter().cloned());
        for part in split_top_level(inner) {
            expand(part, prefix, paths);
        }
        prefix.truncate(prefix.len() - added.len());
    } else if !tree.is_empty() {
        let plain = tree.split(" as ").next().unwrap_or(tree);
        let parts = plain.split("::").map(|part| part.trim().to_owned());
        paths.push(prefix.iter().cloned().chain(parts).collect());
    }
}

fn split_top_level(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// A path of this crate from its root; `None` for other crates.
fn absolute(
    path: &[String],
    file: &str,
    sources: &BTreeMap<String, Source>,
) -> Option<Vec<String>> {
    let module: Vec<String> = match file {
        "lib" => Vec::new(),
        _ => file.split('/').map(Into::into).collect(),
    };
    let rest = &path[1..];
    let from = |base: &[String], rest: &[String]| Some([base, rest].concat());
    match path[0].as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => from(&module, rest),
        "super" => {
            let ups = path.iter().take_while(|part| *part == "super").count();
            from(&module[..module.len().checked_sub(ups)?], &path[ups..])
        }
        first => {
            // A child module.
            let child = module.iter().cloned().chain([first.to_owned()]);
            let child = child.collect::<Vec<_>>().join("/");
            sources
                .contains_key(&child)
                .then(|| [module.as_slice(), path].concat())
        }
    }
}

/// The file that has the item at a path.
fn resolve(
    path: &[String],
    sources: &BTreeMap<String, Source>,
    reexports: &BTreeMap<(String, String), Vec<String>>,
) -> Option<String> {
    let depth = (1..=path.len())
        .rev()
        .find(|depth| sources.contains_key(&path[..*depth].join("/")))?;
    let file = path[..depth].join("/");
    let item = path.get(depth);
    let next = item.and_then(|item| reexports.get(&(file.clone(), item.clone())));
    match next {
        Some(next) if next != path => resolve(next, sources, reexports),
        _ => Some(file),
    }
}
