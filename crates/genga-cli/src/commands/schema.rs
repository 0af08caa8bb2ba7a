use crate::args::{SchemaArgs, SchemaKind};
use crate::console;
use crate::failure::{Failure, Outcome};

/// Prints the JSON Schema of a kind of file.
pub(crate) fn run(args: &SchemaArgs) -> Outcome {
    let schema = match args.kind {
        SchemaKind::Style => genga::style::json_schema(),
        SchemaKind::Scene => genga::scene_file::json_schema(),
    };
    let text = serde_json::to_string_pretty(&schema).map_err(Failure::message)?;
    console::print(&format!("{text}\n"))
}
