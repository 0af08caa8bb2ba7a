//! How a style file changes the one that it extends.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::lines::DEFAULT_SET;

/// Puts what `child` says over what `base` says. Tables are merged key by key, line sets by
/// their names, overrides are appended, everything else is replaced.
///
/// Both have been checked already, so they are no deeper than styles are.
pub(super) fn merge<'a>(base: &mut DeTable<'a>, child: DeTable<'a>) {
    for key in ["name", "description", "extends"] {
        base.remove(key);
    }
    tables(base, child, "");
}

fn tables<'a>(base: &mut DeTable<'a>, child: DeTable<'a>, parent: &str) {
    if parent == "ramp" && child.contains_key("stops") {
        // Stops are not used beside an image, so whoever writes them means them instead.
        base.remove("image");
    }
    for (key, value) in child {
        let name = key.get_ref().clone();
        let Some(old) = base.get_mut(name.as_ref()) else {
            base.insert(key, value);
            continue;
        };
        let span = value.span();
        match (old.get_mut(), value.into_inner()) {
            (DeValue::Table(old), DeValue::Table(new)) => tables(old, new, &name),
            (DeValue::Array(old), DeValue::Array(new)) if name == "override" => {
                new.into_iter().for_each(|element| old.push(element));
            }
            (DeValue::Array(old), DeValue::Array(new)) if name == "sets" => sets(old, new),
            (_, new) => *old = Spanned::new(span, new),
        }
    }
}

fn sets<'a>(old: &mut DeArray<'a>, new: DeArray<'a>) {
    for set in new {
        let name = name_of(&set).to_owned();
        let same = old.iter_mut().find(|old| name_of(old) == name).map(Spanned::get_mut);
        match (same, set.get_ref()) {
            (Some(DeValue::Table(old)), DeValue::Table(new)) => tables(old, new.clone(), ""),
            _ => old.push(set),
        }
    }
}

fn name_of<'a>(set: &'a Spanned<DeValue<'_>>) -> &'a str {
    set.get_ref().get("name").and_then(|name| name.get_ref().as_str()).unwrap_or(DEFAULT_SET)
}
