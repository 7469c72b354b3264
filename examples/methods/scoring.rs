//! The thesis's questionnaire (§ 7.2) as one page, with films to judge.

use base64::{Engine, prelude::BASE64_STANDARD};
use serde_json::{Value, json};

const TEMPLATE: &str = include_str!("scoring.html");
const SCRIPTS: [&str; 2] = [include_str!("scoring.js"), include_str!("page.js")];

/// A film to judge.
pub struct Film {
    pub key: &'static str,
    pub name: &'static str,
    /// The way of a paper's center, as GIF.
    pub track: Vec<u8>,
    /// Nine leaves, if the method can move them.
    pub leaves: Option<Vec<u8>>,
}

/// The page, which loads nothing and sends nothing.
pub fn page(measured: &[u8], films: &[Film]) -> String {
    let data = |bytes: &[u8]| BASE64_STANDARD.encode(bytes);
    let film = |film: &Film| -> Value {
        json!({
            "key": film.key,
            "name": film.name,
            "track": data(&film.track),
            "leaves": film.leaves.as_ref().map(|bytes| data(bytes)),
        })
    };
    let content = json!({
        "measured": data(measured),
        "films": films.iter().map(film).collect::<Vec<_>>(),
    });
    // A "</script>" in a name would end the element.
    let content = content.to_string().replace('<', "\\u003c");
    TEMPLATE
        .replace("{{script}}", &SCRIPTS.join("\n"))
        .replace("{{content}}", &content)
}
