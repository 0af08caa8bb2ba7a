//! Names of output files: `{model}_{frame:04}.png`.

use std::fmt::Write as _;

use crate::text::nearest;

/// What a template may say, with a word on each.
pub(crate) const FIELDS: [(&str, &str); 4] = [
    ("model", "name of the model or scene, without folder and ending"),
    ("style", "name of the style"),
    ("frame", "number of the frame"),
    ("index", "number of the picture, from 0"),
];

/// An output name with places to fill in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Template {
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Model,
    Style,
    Frame { width: usize },
    Index { width: usize },
}

/// What the places are filled with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fields<'a> {
    pub(crate) model: &'a str,
    pub(crate) style: &'a str,
    pub(crate) frame: i64,
    pub(crate) index: usize,
}

impl Template {
    /// Reads a template; `{{` and `}}` stand for braces.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        let mut plain = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            plain.push_str(&rest[..at]);
            let brace = &rest[at..=at];
            rest = &rest[at + 1..];
            if let Some(after) = rest.strip_prefix(brace) {
                plain.push_str(brace);
                rest = after;
                continue;
            }
            if brace == "}" {
                return Err(format!("'}}' without '{{' in '{text}'; write '}}}}' for a brace"));
            }
            let Some((field, after)) = rest.split_once('}') else {
                return Err(format!("'{{' without '}}' in '{text}'; write '{{{{' for a brace"));
            };
            rest = after;
            if !plain.is_empty() {
                parts.push(Part::Text(std::mem::take(&mut plain)));
            }
            parts.push(Part::parse(field)?);
        }
        plain.push_str(rest);
        if !plain.is_empty() {
            parts.push(Part::Text(plain));
        }
        if parts.is_empty() {
            return Err("the name is empty".to_owned());
        }
        Ok(Self { parts })
    }

    /// The name with everything filled in.
    pub(crate) fn fill(&self, fields: &Fields<'_>) -> String {
        let mut name = String::new();
        for part in &self.parts {
            // Writing to a string cannot fail.
            let _ = match part {
                Part::Text(text) => write!(name, "{text}"),
                Part::Model => write!(name, "{}", as_file_name(fields.model)),
                Part::Style => write!(name, "{}", as_file_name(fields.style)),
                Part::Frame { width } => write!(name, "{:0width$}", fields.frame),
                Part::Index { width } => write!(name, "{:0width$}", fields.index),
            };
        }
        name
    }

    /// Whether frames get different names.
    pub(crate) fn tells_frames_apart(&self) -> bool {
        self.parts.iter().any(|part| matches!(part, Part::Frame { .. } | Part::Index { .. }))
    }
}

impl Part {
    fn parse(field: &str) -> Result<Self, String> {
        let (name, width) = match field.split_once(':') {
            Some((name, width)) => (name, Some(width)),
            None => (field, None),
        };
        let digits = || match width {
            None => Ok(0),
            Some(width) => match width.trim_start_matches('0').parse() {
                Ok(width @ 1..=20) => Ok(width),
                _ => Err(format!(
                    "'{{{field}}}' asks for no number of digits; write it like '{{{name}:04}}'"
                )),
            },
        };
        match name {
            "model" | "style" if width.is_some() => {
                Err(format!("'{{{field}}}' has digits, but is no number; write '{{{name}}}'"))
            }
            "model" => Ok(Self::Model),
            "style" => Ok(Self::Style),
            "frame" => Ok(Self::Frame { width: digits()? }),
            "index" => Ok(Self::Index { width: digits()? }),
            _ => {
                let known = FIELDS.map(|(name, _)| name);
                let meant = match nearest(name, known) {
                    Some(meant) => format!(", did you mean '{{{meant}}}'?"),
                    None => String::new(),
                };
                let list = known.map(|name| format!("{{{name}}}")).join(", ");
                Err(format!("unknown field '{{{field}}}'{meant} (known: {list})"))
            }
        }
    }
}

/// A name without what would lead to another folder.
fn as_file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_control() || "/\\:".contains(c) { '_' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELDS: Fields<'_> = Fields { model: "Knight", style: "anime", frame: 7, index: 12 };

    fn fill(text: &str) -> String {
        Template::parse(text).expect("a template").fill(&FIELDS)
    }

    #[test]
    fn fields_are_filled_in() {
        assert_eq!(fill("out.png"), "out.png");
        assert_eq!(fill("{model}.png"), "Knight.png");
        assert_eq!(fill("a/{model}-{style}_{frame:04}.png"), "a/Knight-anime_0007.png");
        assert_eq!(fill("{frame:4}{index}{index:03}"), "000712012");
        assert_eq!(fill("{{{model}}}.png"), "{Knight}.png");
    }

    #[test]
    fn a_negative_frame_keeps_its_sign() {
        let fields = Fields { frame: -3, ..FIELDS };
        assert_eq!(Template::parse("{frame:04}").map(|t| t.fill(&fields)), Ok("-003".to_owned()));
    }

    #[test]
    fn names_cannot_leave_the_folder() {
        let fields = Fields { model: "../a:b\\c", ..FIELDS };
        let name = Template::parse("{model}.png").map(|t| t.fill(&fields));
        assert_eq!(name, Ok(".._a_b_c.png".to_owned()));
    }

    #[test]
    fn mistakes_are_explained() {
        let error = |text: &str| Template::parse(text).expect_err("a mistake");
        assert!(error("{modle}.png").contains("did you mean '{model}'?"));
        assert!(error("{zzzzzz}").contains("known: {model}, {style}, {frame}, {index}"));
        assert!(error("{model").contains("without '}'"));
        assert!(error("model}").contains("without '{'"));
        assert!(error("{frame:x}").contains("{frame:04}"));
        assert!(error("{frame:99}").contains("{frame:04}"));
        assert!(error("{model:04}").contains("write '{model}'"));
        assert!(error("").contains("empty"));
    }

    #[test]
    fn only_numbers_tell_frames_apart() {
        let tells = |text| Template::parse(text).map(|t| t.tells_frames_apart());
        assert_eq!(tells("{model}.png"), Ok(false));
        assert_eq!(tells("{frame}.png"), Ok(true));
        assert_eq!(tells("{index}.png"), Ok(true));
    }
}
