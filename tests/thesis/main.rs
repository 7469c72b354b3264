//! `docs/thesis.md` is what the example `thesis` would write, from what it measured last and from what is computed at once.

#[path = "../../examples/thesis/chapter_2_3.rs"]
mod chapter_2_3;
#[path = "../../examples/thesis/chapter_4.rs"]
mod chapter_4;
#[path = "../../examples/thesis/chapter_5.rs"]
mod chapter_5;
#[path = "../../examples/thesis/chapter_6_7.rs"]
mod chapter_6_7;
#[path = "../../examples/thesis/contents.rs"]
mod contents;
#[path = "../../examples/thesis/entry.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod entry;
#[path = "../../examples/thesis/page.rs"]
mod page;

use contents::{COMMAND, RUNS, chapters};
use std::path::Path;

#[test]
fn the_page_of_the_thesis_is_current() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let read = |name: &str| std::fs::read_to_string(docs.join(name)).unwrap();
    let measured = serde_json::from_str(&read("thesis.json")).unwrap();
    let page = page::render(&chapters(), RUNS, COMMAND, &measured).unwrap();
    assert!(page == read("thesis.md"), "run: {COMMAND}");
    for entry in chapters().iter().flat_map(|chapter| chapter.entries) {
        for picture in entry.pictures {
            let path = docs
                .join("thesis")
                .join(entry.example.unwrap())
                .join(picture);
            assert!(path.exists(), "{}: {}", entry.name, path.display());
        }
        let said =
            !entry.numbers.is_empty() || !entry.pictures.is_empty() || !entry.remark.is_empty();
        assert!(said, "{}: nothing is said of it", entry.name);
    }
}
