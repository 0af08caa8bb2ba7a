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
        if let [Value::Object(only)] = choices.as_slice() {
            let only = only.clone();
            schema.remove("anyOf");
            schema.extend(only);
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
