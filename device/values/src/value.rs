//! The values of a packet, with the layout that names them.

use super::field::{Field, Kind};

/// The value of one field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// A raw number.
    Int(i64),
    /// Text without its end mark or padding.
    Text(String),
    /// Bytes as they are.
    Bytes(Vec<u8>),
    /// The records behind a count byte, each with its raw numbers in order.
    Records(Vec<Vec<i64>>),
}

impl Value {
    /// The number, if it is one.
    pub const fn as_int(&self) -> Option<i64> {
        match self {
            Self::Int(value) => Some(*value),
            Self::Text(_) | Self::Bytes(_) | Self::Records(_) => None,
        }
    }
}

impl From<i64> for Value {
    fn from(value: i64) -> Self {
        Self::Int(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

/// Values and the layout that names them: the arguments of a request or the content of a reply.
#[derive(Debug, Clone, Default)]
pub struct Values {
    fields: &'static [Field],
    values: Vec<Value>,
    /// Which field each value is of; empty when they are of all in order.
    picked: Vec<usize>,
}

impl Values {
    /// Values in the order of `fields`. Values beyond the layout are dropped.
    pub fn new(fields: &'static [Field], mut values: Vec<Value>) -> Self {
        values.truncate(fields.len());
        Self { fields, values, picked: Vec::new() }
    }

    /// Values of some fields of a layout, each by its index. What the layout does not have is dropped.
    pub fn picked(fields: &'static [Field], values: impl IntoIterator<Item = (usize, Value)>) -> Self {
        let (picked, values) = values.into_iter().filter(|(index, _)| *index < fields.len()).unzip();
        Self { fields, values, picked }
    }

    /// The layout.
    pub const fn fields(&self) -> &'static [Field] {
        self.fields
    }

    /// The values in wire order.
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// Whether there are none, as in an acknowledgement.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Each field with its value, in wire order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Field, &Value)> {
        let field = |at: usize| &self.fields[self.picked.get(at).copied().unwrap_or(at)];
        self.values.iter().enumerate().map(move |(at, value)| (field(at), value))
    }

    /// The value of the field `name`; `None` if this generation's layout has no such field.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.iter().find(|(field, _)| field.name == name).map(|(_, value)| value)
    }

    /// The raw number of the field `name`; `None` if this generation's layout has no such number.
    pub fn try_int(&self, name: &str) -> Option<i64> {
        self.get(name).and_then(Value::as_int)
    }

    /// The physical value of the field `name`, in its [`Field::unit`](field@Field::unit); `None` if there is no such number.
    pub fn physical(&self, name: &str) -> Option<f64> {
        let (field, value) = self.iter().find(|(field, _)| field.name == name)?;
        Some(field.physical(value.as_int()?))
    }

    /// The raw numbers of all fields that are numbers, in wire order.
    pub fn ints(&self) -> impl Iterator<Item = i64> {
        self.values.iter().filter_map(Value::as_int)
    }

    /// The text of the field `name`; `None` if there is no such text.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Text(text) => Some(text),
            Value::Int(_) | Value::Bytes(_) | Value::Records(_) => None,
        }
    }

    /// The bytes of the field `name`; `None` if there are no such bytes.
    pub fn bytes(&self, name: &str) -> Option<&[u8]> {
        match self.get(name)? {
            Value::Bytes(bytes) => Some(bytes),
            Value::Int(_) | Value::Text(_) | Value::Records(_) => None,
        }
    }

    /// The records of the first counted field; none if there is no such field.
    pub fn records(&self) -> impl Iterator<Item = Record<'_>> {
        let counted = self.iter().find_map(|(field, value)| match (&field.kind, value) {
            (Kind::Counted(fields), Value::Records(records)) => Some((*fields, records.as_slice())),
            _ => None,
        });
        let (fields, records) = counted.unwrap_or((&[], &[]));
        records.iter().map(move |ints| Record { fields, ints })
    }

    fn names(&self) -> Vec<&'static str> {
        self.iter().map(|(field, _)| field.name).collect()
    }
}

impl PartialEq for Values {
    /// Equal names and equal values.
    fn eq(&self, other: &Self) -> bool {
        self.values == other.values && self.names() == other.names()
    }
}

/// One record of a counted reply.
#[derive(Debug, Clone, Copy)]
pub struct Record<'a> {
    fields: &'static [Field],
    ints: &'a [i64],
}

impl<'a> Record<'a> {
    /// The layout.
    pub const fn fields(&self) -> &'static [Field] {
        self.fields
    }

    /// The raw numbers in wire order.
    pub const fn ints(&self) -> &'a [i64] {
        self.ints
    }

    /// The raw number of the field `name`; `None` if this generation's record has no such field.
    pub fn try_int(&self, name: &str) -> Option<i64> {
        let index = self.fields.iter().position(|field| field.name == name)?;
        self.ints.get(index).copied()
    }
}
