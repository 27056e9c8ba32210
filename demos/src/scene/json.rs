//! A JSON tree that remembers nothing but values, and readers that say which field is wrong.
//!
//! Duties: refuse repeated fields and endless documents while the tree is built; check type, range and length
//! of each value. A fault starts at the value and collects its path on the way out, so a good file pays nothing.

use std::cell::Cell;
use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

use crate::error::Error;
use crate::limits::MAX_JSON_VALUES;

/// One JSON value.
#[derive(Debug)]
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(Box<str>),
    List(Vec<Json>),
    Fields(Vec<(Box<str>, Json)>),
}

/// A value that must not be there, and the way to it.
#[derive(Debug)]
pub(super) struct Fault {
    /// Innermost first.
    steps: Vec<Step>,
    pub(super) expected: String,
    pub(super) found: String,
}

#[derive(Debug)]
enum Step {
    Field(String),
    Item(usize),
}

pub(super) type Read<T> = Result<T, Fault>;

impl Fault {
    pub(super) fn new(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { steps: Vec::new(), expected: expected.into(), found: found.into() }
    }

    pub(super) fn in_field(mut self, name: &str) -> Self {
        self.steps.push(Step::Field(name.to_owned()));
        self
    }

    pub(super) fn in_item(mut self, index: usize) -> Self {
        self.steps.push(Step::Item(index));
        self
    }

    /// As an error of the scene file `file`.
    pub(super) fn in_file(self, file: &Path) -> Error {
        Error::Field { file: file.to_path_buf(), path: self.path(), expected: self.expected, found: self.found }
    }

    /// The path from the root, for example `draw[2].triangles.vertices[1]`.
    pub(super) fn path(&self) -> String {
        let mut path = String::new();
        for step in self.steps.iter().rev() {
            match step {
                Step::Item(index) => path.push_str(&format!("[{index}]")),
                Step::Field(name) if is_plain(name) => {
                    if !path.is_empty() {
                        path.push('.');
                    }
                    path.push_str(name);
                }
                Step::Field(name) => path.push_str(&format!("[{}]", quoted(name))),
            }
        }
        if path.is_empty() { "the document".to_owned() } else { path }
    }
}

/// Names that need no quotes in a path.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A text in quotes, cut when it is long.
pub(super) fn quoted(text: &str) -> String {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}...", &text[..end]),
        None => format!("{text:?}"),
    }
}

impl Json {
    /// Reads a document; the error carries line and column.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, serde_json::Error> {
        let left = Cell::new(MAX_JSON_VALUES);
        let mut deserializer = serde_json::Deserializer::from_slice(bytes);
        let tree = Seed(&left).deserialize(&mut deserializer)?;
        deserializer.end()?;
        Ok(tree)
    }

    /// What the value is, for messages.
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Null => "null".to_owned(),
            Self::Bool(value) => value.to_string(),
            Self::Number(value) => value.to_string(),
            Self::Text(text) => quoted(text),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Fields(fields) => match fields.first() {
                Some((name, _)) => format!("an object with {}", quoted(name)),
                None => "an empty object".to_owned(),
            },
        }
    }

    fn wrong(&self, expected: impl Into<String>) -> Fault {
        Fault::new(expected, self.describe())
    }

    /// A finite number in `range`, as f32.
    pub(super) fn number(&self, range: RangeInclusive<f32>) -> Read<f32> {
        let expected = || {
            if range == ANY {
                "a finite number".to_owned()
            } else {
                format!("a number in {}..={}", range.start(), range.end())
            }
        };
        match self {
            Self::Number(wide) => {
                let value = *wide as f32;
                if value.is_finite() && range.contains(&value) { Ok(value) } else { Err(self.wrong(expected())) }
            }
            _ => Err(self.wrong(expected())),
        }
    }

    /// A number above zero.
    pub(super) fn positive(&self) -> Read<f32> {
        self.number(ANY).ok().filter(|value| *value > 0.0).ok_or_else(|| self.wrong("a finite number above 0"))
    }

    /// A whole number in `range`.
    pub(super) fn whole(&self, range: RangeInclusive<u32>) -> Read<u32> {
        match self {
            Self::Number(value)
                if value.fract() == 0.0 && (f64::from(*range.start())..=f64::from(*range.end())).contains(value) =>
            {
                Ok(*value as u32)
            }
            _ => Err(self.wrong(format!("a whole number in {}..={}", range.start(), range.end()))),
        }
    }

    pub(super) fn flag(&self) -> Read<bool> {
        match self {
            Self::Bool(value) => Ok(*value),
            _ => Err(self.wrong("true or false")),
        }
    }

    pub(super) fn text(&self) -> Read<&str> {
        match self {
            Self::Text(text) => Ok(text),
            _ => Err(self.wrong("a text")),
        }
    }

    /// The name of a file: a text that is not empty.
    pub(super) fn file_name(&self) -> Read<&str> {
        self.text()
            .ok()
            .filter(|text| !text.is_empty() && !text.contains('\0'))
            .ok_or_else(|| self.wrong("a file name"))
    }

    /// One of the named values.
    pub(super) fn named<T: Copy>(&self, named: &[(&str, T)]) -> Read<T> {
        let found = self.text().ok().and_then(|text| named.iter().find(|(name, _)| *name == text));
        found.map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<String> = named.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            self.wrong(format!("one of {}", names.join(", ")))
        })
    }

    /// A list with `least..=most` items of one kind, called `what` in messages.
    pub(super) fn list<T>(
        &self,
        what: &str,
        count: RangeInclusive<usize>,
        read: impl Fn(&Self) -> Read<T>,
    ) -> Read<Vec<T>> {
        match self {
            Self::List(items) if count.contains(&items.len()) => {
                items.iter().enumerate().map(|(i, item)| read(item).map_err(|fault| fault.in_item(i))).collect()
            }
            _ if *count.end() == usize::MAX => Err(self.wrong(format!("a list of at least {} {what}", count.start()))),
            _ => Err(self.wrong(format!("a list of {} to {} {what}", count.start(), count.end()))),
        }
    }

    /// A list of exactly N items, called `what` in messages.
    pub(super) fn array<T, const N: usize>(&self, what: &str, read: impl Fn(&Self) -> Read<T>) -> Read<[T; N]> {
        let wrong = || self.wrong(format!("a list of {N} {what}"));
        let Self::List(items) = self else { return Err(wrong()) };
        if items.len() != N {
            return Err(wrong());
        }
        let read: Vec<T> = self.list(what, N..=N, read)?;
        read.try_into().map_err(|_: Vec<T>| wrong())
    }

    /// N finite numbers.
    pub(super) fn numbers<const N: usize>(&self) -> Read<[f32; N]> {
        self.array("numbers", |item| item.number(ANY))
    }

    /// Red, green, blue, alpha.
    pub(super) fn colour(&self) -> Read<[u8; 4]> {
        let channels = self.array("whole numbers in 0..=255", |item| item.whole(0..=255))?;
        Ok(channels.map(|channel: u32| channel as u8))
    }

    /// An object that has no other fields than `known`.
    pub(super) fn object(&self, known: &'static [&'static str]) -> Read<Object<'_>> {
        let Self::Fields(fields) = self else { return Err(self.wrong("an object")) };
        match fields.iter().find(|(name, _)| !known.contains(&&**name)) {
            Some((name, _)) if known.is_empty() => Err(Fault::new("no fields here", "an unknown field").in_field(name)),
            Some((name, _)) => {
                let expected = format!("one of the fields {}", known.join(", "));
                Err(Fault::new(expected, "an unknown field").in_field(name))
            }
            None => Ok(Object { fields }),
        }
    }

    /// An object with any fields, in the file's order.
    pub(super) fn entries(&self) -> Read<&[(Box<str>, Self)]> {
        match self {
            Self::Fields(fields) => Ok(fields),
            _ => Err(self.wrong("an object")),
        }
    }

    /// An object with exactly one field, which is one of `kinds`: a tagged value.
    pub(super) fn tagged(&self, kinds: &'static [&'static str]) -> Read<(&'static str, &Self)> {
        let wrong = || self.wrong(format!("an object with exactly one of {}", kinds.join(", ")));
        let Self::Fields(fields) = self else { return Err(wrong()) };
        self.object(kinds)?;
        let [(name, value)] = &fields[..] else {
            return Err(match fields.len() {
                0 => wrong(),
                count => Fault::new(format!("exactly one of {}", kinds.join(", ")), format!("{count} fields")),
            });
        };
        let kind = kinds.iter().find(|kind| **kind == &**name).ok_or_else(wrong)?;
        Ok((kind, value))
    }
}

/// Every finite f32.
pub(super) const ANY: RangeInclusive<f32> = f32::MIN..=f32::MAX;

/// The fields of an object, all known by name.
pub(super) struct Object<'a> {
    fields: &'a [(Box<str>, Json)],
}

impl<'a> Object<'a> {
    pub(super) fn get(&self, name: &str) -> Option<&'a Json> {
        self.fields.iter().find(|(field, _)| &**field == name).map(|(_, value)| value)
    }

    /// The field if it is there.
    pub(super) fn optional<T>(&self, name: &str, read: impl FnOnce(&'a Json) -> Read<T>) -> Read<Option<T>> {
        self.get(name).map(|value| read(value).map_err(|fault| fault.in_field(name))).transpose()
    }

    /// The field, or `default` if it is absent.
    pub(super) fn or<T>(&self, name: &str, default: T, read: impl FnOnce(&'a Json) -> Read<T>) -> Read<T> {
        Ok(self.optional(name, read)?.unwrap_or(default))
    }

    /// The field, which must be there.
    pub(super) fn required<T>(&self, name: &str, read: impl FnOnce(&'a Json) -> Read<T>) -> Read<T> {
        self.optional(name, read)?.ok_or_else(|| Fault::new("this field", "nothing").in_field(name))
    }
}

/// Builds a tree and counts its values down.
struct Seed<'a>(&'a Cell<usize>);

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Json;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Json, D::Error> {
        let left = self.0.get().checked_sub(1);
        self.0.set(left.ok_or_else(|| D::Error::custom(format!("more than {MAX_JSON_VALUES} values")))?);
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Json;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Bool(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json, E> {
        Ok(Json::Number(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Text(value.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Json, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element_seed(Seed(self.0))? {
            items.push(item);
        }
        Ok(Json::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let mut fields: Vec<(Box<str>, Json)> = Vec::new();
        let mut names = std::collections::HashSet::new();
        while let Some(name) = map.next_key::<Box<str>>()? {
            if !names.insert(name.clone()) {
                return Err(A::Error::custom(format!("the field {} is there twice", quoted(&name))));
            }
            fields.push((name, map.next_value_seed(Seed(self.0))?));
        }
        Ok(Json::Fields(fields))
    }
}
