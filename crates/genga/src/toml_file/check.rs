//! Comparing a parsed file with its JSON Schema.
//!
//! Only the parts of JSON Schema that `schema_of` makes are understood.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error as _, SeqAccess, Visitor};
use serde_json::Value as Schema;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::nearest;

/// The version of both kinds of files.
const VERSION: &str = "1";

/// What is wrong, and where.
pub(super) struct Problem {
    pub(super) span: Range<usize>,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl Problem {
    fn new(span: Range<usize>, message: String) -> Self {
        Self { span, message, help: None }
    }
}

/// The version is looked at first: a file of another version has other keys.
pub(super) fn version(table: &DeTable<'_>) -> Result<(), Problem> {
    let Some(version) = table.get("version") else {
        let message = "missing key 'version'".to_owned();
        let help = Some(format!("write 'version = {VERSION}' in the first line"));
        return Err(Problem { span: 0..0, message, help });
    };
    match version.get_ref() {
        DeValue::Integer(number) if number.as_str() == VERSION => Ok(()),
        other => Err(Problem {
            span: version.span(),
            message: format!("'version' must be {VERSION}, not {}", found(other)),
            help: matches!(other, DeValue::Integer(_))
                .then(|| "a newer Genga may know this version".to_owned()),
        }),
    }
}

/// The whole file.
pub(super) fn table(table: &Spanned<DeTable<'_>>, root: &Schema) -> Result<(), Problem> {
    Checker { root }.table(table.get_ref(), &table.span(), root)
}

struct Checker<'a> {
    root: &'a Schema,
}

impl<'a> Checker<'a> {
    /// The schema that a `$ref` stands for.
    fn resolve(&self, schema: &'a Schema) -> &'a Schema {
        // Draft 7 allows nothing beside a `$ref`, so one with a description is wrapped.
        let inner = schema.pointer("/allOf/0").unwrap_or(schema);
        let Some(target) = inner.get("$ref").and_then(Schema::as_str) else { return inner };
        target.strip_prefix('#').and_then(|p| self.root.pointer(p)).unwrap_or(schema)
    }

    fn table(
        &self,
        table: &DeTable<'_>,
        span: &Range<usize>,
        schema: &'a Schema,
    ) -> Result<(), Problem> {
        let empty = serde_json::Map::new();
        let known = schema.get("properties").and_then(Schema::as_object).unwrap_or(&empty);
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            let Some(schema) = known.get(name) else {
                return Err(unknown_key(key.span(), name, known.keys().map(String::as_str)));
            };
            self.value(name, value, schema)?;
        }
        let required = schema.get("required").and_then(Schema::as_array).into_iter().flatten();
        for name in required.filter_map(Schema::as_str) {
            if !table.contains_key(name) {
                return Err(Problem::new(span.clone(), format!("missing key '{name}'")));
            }
        }
        Ok(())
    }

    fn value(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        schema: &'a Schema,
    ) -> Result<(), Problem> {
        let schema = self.resolve(schema);
        let wrong = || {
            let expected = self.expected(schema);
            let message = format!("'{key}' must be {expected}, not {}", found(value.get_ref()));
            Problem::new(value.span(), message)
        };
        if let Some(choices) = schema.get("anyOf").and_then(Schema::as_array) {
            // Choices differ in their types, so the value's own type tells which one is meant.
            let kind = kind(value.get_ref());
            let choice = choices.iter().map(|c| self.resolve(c)).find(|c| {
                let wanted = c.get("type").and_then(Schema::as_str);
                wanted == Some(kind) || (wanted == Some("number") && kind == "integer")
            });
            return self.value(key, value, choice.ok_or_else(wrong)?);
        }
        if let Some(names) = names(schema) {
            let DeValue::String(name) = value.get_ref() else { return Err(wrong()) };
            if names.contains(&name.as_ref()) {
                return Ok(());
            }
            let problem = wrong();
            let meant = nearest(name, names).map(|name| format!("did you mean \"{name}\"?"));
            return Err(Problem { help: meant, ..problem });
        }
        match (schema.get("type").and_then(Schema::as_str), value.get_ref()) {
            (Some("object"), DeValue::Table(table)) => self.table(table, &value.span(), schema),
            (Some("array"), DeValue::Array(array)) => {
                let limit = |name| schema.get(name).and_then(Schema::as_u64);
                let count = array.len() as u64;
                if limit("minItems").is_some_and(|min| count < min)
                    || limit("maxItems").is_some_and(|max| count > max)
                {
                    return Err(wrong());
                }
                let Some(items) = schema.get("items") else { return Ok(()) };
                array.iter().try_for_each(|element| self.value(key, element, items))
            }
            (Some("array"), DeValue::Table(_)) => {
                let items = schema.get("items").map(|items| self.resolve(items));
                let of_tables = items.is_some_and(|i| i.get("properties").is_some());
                let help = of_tables.then(|| "begin each with two brackets: '[[…]]'".to_owned());
                Err(Problem { help, ..wrong() })
            }
            (Some("string"), DeValue::String(_)) | (Some("boolean"), DeValue::Boolean(_)) => Ok(()),
            (Some("integer"), DeValue::Integer(number)) => {
                let number = i64::from_str_radix(number.as_str(), number.radix());
                match number {
                    Ok(number) if in_range(schema, number as f64) => Ok(()),
                    _ => Err(wrong()),
                }
            }
            (Some("number"), DeValue::Integer(_) | DeValue::Float(_)) => {
                match number(value.get_ref()) {
                    Some(number) if in_range(schema, number) => Ok(()),
                    _ => Err(wrong()),
                }
            }
            _ => Err(wrong()),
        }
    }

    /// What a schema asks for, in words.
    fn expected(&self, schema: &'a Schema) -> String {
        let schema = self.resolve(schema);
        if let Some(choices) = schema.get("anyOf").and_then(Schema::as_array) {
            let choices: Vec<String> = choices.iter().map(|c| self.expected(c)).collect();
            return choices.join(" or ");
        }
        if let Some(names) = names(schema) {
            let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
            return any_of(&names);
        }
        let limit = |name: &str| schema.get(name).and_then(Schema::as_f64);
        let range = match (limit("minimum"), limit("exclusiveMinimum"), limit("maximum")) {
            (Some(min), _, Some(max)) => format!(" from {min} to {max}"),
            (None, Some(min), Some(max)) => format!(" over {min} and up to {max}"),
            (Some(min), _, None) => format!(" of at least {min}"),
            (None, Some(min), None) => format!(" over {min}"),
            (None, None, Some(max)) => format!(" of at most {max}"),
            (None, None, None) => String::new(),
        };
        match schema.get("type").and_then(Schema::as_str) {
            Some("object") => "a table".to_owned(),
            Some("array") => {
                let limit = |name| schema.get(name).and_then(Schema::as_u64);
                let element = schema.get("items").map(|items| self.expected(items));
                let element = element.map(|e| format!(", each {e}")).unwrap_or_default();
                match (limit("minItems"), limit("maxItems")) {
                    (Some(min), Some(max)) if min == max => format!("a list of {min}{element}"),
                    (Some(min), Some(max)) => format!("a list of {min} to {max}{element}"),
                    (None, Some(max)) => format!("a list of at most {max}{element}"),
                    _ => format!("a list{element}"),
                }
            }
            Some("boolean") => "true or false".to_owned(),
            Some("integer") => format!("a whole number{range}"),
            Some("number") => format!("a number{range}"),
            _ => "a text in quotes".to_owned(),
        }
    }
}

fn unknown_key<'a>(
    span: Range<usize>,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Problem {
    let name_shown = shorten(name);
    let names: Vec<String> = known.clone().map(|known| format!("'{known}'")).collect();
    let message = match nearest(name, known) {
        Some(known) => format!("unknown key '{name_shown}', did you mean '{known}'?"),
        None => format!("unknown key '{name_shown}'"),
    };
    Problem { span, message, help: Some(format!("known here: {}", names.join(", "))) }
}

/// The names that an enum may have: `enum = […]` or `oneOf = [{ const = … }, …]`.
fn names(schema: &Schema) -> Option<Vec<&str>> {
    if let Some(names) = schema.get("enum").and_then(Schema::as_array) {
        return Some(names.iter().filter_map(Schema::as_str).collect());
    }
    let choices = schema.get("oneOf").and_then(Schema::as_array)?;
    let names = choices.iter().flat_map(|choice| match choice.get("const") {
        Some(name) => name.as_str().into_iter().collect(),
        None => names(choice).unwrap_or_default(),
    });
    Some(names.collect())
}

fn in_range(schema: &Schema, number: f64) -> bool {
    let limit = |name: &str| schema.get(name).and_then(Schema::as_f64);
    // As the data will have it: an f32 must not become infinite either.
    (number as f32).is_finite()
        && limit("minimum").is_none_or(|min| number >= min)
        && limit("exclusiveMinimum").is_none_or(|min| number as f32 > min as f32)
        && limit("maximum").is_none_or(|max| number <= max)
        && limit("exclusiveMaximum").is_none_or(|max| (number as f32) < max as f32)
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).ok().map(|n| n as f64),
        DeValue::Float(n) => n.as_str().parse().ok(),
        _ => None,
    }
}

/// The JSON Schema name of a value's type.
fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) | DeValue::Datetime(_) => "string",
        DeValue::Integer(_) => "integer",
        DeValue::Float(_) => "number",
        DeValue::Boolean(_) => "boolean",
        DeValue::Array(_) => "array",
        DeValue::Table(_) => "object",
    }
}

/// What stands in the file, in words.
fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("\"{}\"", shorten(text)),
        DeValue::Integer(number) => shorten(&number.to_string()),
        DeValue::Float(number) => shorten(number.as_str()),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(array) => format!("a list of {}", array.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// A text that is short and harmless enough for a message.
fn shorten(text: &str) -> String {
    const MAX: usize = 40;
    let mut short: String = text.chars().take(MAX).flat_map(char::escape_debug).collect();
    if text.chars().nth(MAX).is_some() {
        short.push('…');
    }
    short
}

/// `a, b or c`.
fn any_of(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [name] => name.clone(),
        [names @ .., last] => format!("{} or {last}", names.join(", ")),
    }
}

/// Reads a list whose elements must also satisfy a rule that looks at the ones before.
///
/// A broken rule is reported at the element's own place.
pub(crate) fn list_with<'de, D, T>(
    deserializer: D,
    rule: impl Fn(&[T], &T) -> Result<(), String>,
) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    struct List<R, T>(R, PhantomData<T>);

    impl<'de, T: Deserialize<'de>, R: Fn(&[T], &T) -> Result<(), String>> Visitor<'de> for List<R, T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a list")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<T>, A::Error> {
            let mut list = Vec::new();
            while let Some(element) =
                seq.next_element_seed(Element { before: &list, rule: &self.0 })?
            {
                list.push(element);
            }
            Ok(list)
        }
    }

    struct Element<'a, R, T> {
        before: &'a [T],
        rule: &'a R,
    }

    impl<'de, T: Deserialize<'de>, R: Fn(&[T], &T) -> Result<(), String>> DeserializeSeed<'de>
        for Element<'_, R, T>
    {
        type Value = T;

        // As a newtype, since that is where the TOML reader adds the place to an error.
        fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error> {
            deserializer.deserialize_newtype_struct("", self)
        }
    }

    impl<'de, T: Deserialize<'de>, R: Fn(&[T], &T) -> Result<(), String>> Visitor<'de>
        for Element<'_, R, T>
    {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an element of a list")
        }

        fn visit_newtype_struct<D: Deserializer<'de>>(self, d: D) -> Result<T, D::Error> {
            let element = T::deserialize(d)?;
            (self.rule)(self.before, &element).map_err(D::Error::custom)?;
            Ok(element)
        }
    }

    deserializer.deserialize_seq(List(rule, PhantomData))
}
