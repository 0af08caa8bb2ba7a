use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use serde_json::Value;

/// The JSON Schema of a file that holds a `T`.
pub(crate) fn schema_of<T: JsonSchema>(title: &str) -> Value {
    let generator = SchemaSettings::draft07().with_transform(ForToml).into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    schema.insert("title".to_owned(), title.into());
    schema.to_value()
}

/// Makes a schema say what holds in TOML.
#[derive(Clone)]
struct ForToml;

impl Transform for ForToml {
    fn transform(&mut self, schema: &mut schemars::Schema) {
        if let Some(schema) = schema.as_object_mut() {
            drop_null(schema);
            // Editors warn about formats that they do not know.
            schema.remove("format");
            schema.values_mut().for_each(round_floats);
            if let Some(Value::String(text)) = schema.get_mut("description") {
                *text = text.replace('\n', " ");
            }
        }
        transform_subschemas(self, schema);
    }
}

/// TOML has no null: a key is there or not.
fn drop_null(schema: &mut serde_json::Map<String, Value>) {
    if schema.get("default").is_some_and(Value::is_null) {
        schema.remove("default");
    }
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|t| t != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|c| c.get("type").is_none_or(|t| t != "null"));
        if let [only] = choices.as_slice() {
            // Not the bare `$ref`: draft 7 allows no description beside one.
            let only = only.clone();
            schema.remove("anyOf");
            schema.insert("allOf".to_owned(), vec![only].into());
        }
    }
}

/// Single-precision defaults, written as a person would: 0.3 and not 0.30000001192092896.
fn round_floats(value: &mut Value) {
    match value {
        Value::Number(number) => {
            let short = number.as_f64().filter(|f| f64::from(*f as f32) == *f);
            let short = short.and_then(|f| (f as f32).to_string().parse::<f64>().ok());
            if let Some(short) = short.filter(|_| number.is_f64()) {
                *value = short.into();
            }
        }
        Value::Array(array) => array.iter_mut().for_each(round_floats),
        _ => {}
    }
}

/// Compares a schema with the copy in `assets/schema`, or writes that copy anew where the
/// environment has `GENGA_UPDATE`.
#[cfg(test)]
pub(crate) fn assert_schema_is_fresh(file: &str, schema: &Value) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/schema");
    let path = path.join(file);
    let text = serde_json::to_string_pretty(schema).expect("a schema is plain JSON") + "\n";
    if std::env::var_os("GENGA_UPDATE").is_some() {
        std::fs::write(&path, &text).expect("the source tree can be written");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed.replace("\r\n", "\n") == text,
        "assets/schema/{file} is out of date: run `GENGA_UPDATE=1 cargo test -p genga schema`"
    );
}
