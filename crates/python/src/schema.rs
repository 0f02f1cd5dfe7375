//! Names of a project's commands and of their fields, found by asking the types themselves how they would be read: a
//! deserialiser that notes which names are expected, and then gives up.

use crate::arrays::wrong;
use project::Command;
use pyo3::prelude::*;
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, VariantAccess, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use std::collections::BTreeMap;

type Given = serde::de::value::Error;

/// What is expected.
#[derive(Default)]
struct Names {
    variants: &'static [&'static str],
    fields: &'static [&'static str],
}

/// Reads the variant at a position, or nothing, and notes the names.
struct Asker<'a> {
    names: &'a mut Names,
    position: Option<usize>,
}

fn enough() -> Given {
    Given::custom("the names are known")
}

impl<'de> Deserializer<'de> for Asker<'_> {
    type Error = Given;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Given> {
        Err(enough())
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Given> {
        self.names.variants = variants;
        if self.position.is_none() { Err(enough()) } else { visitor.visit_enum(self) }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Given> {
        self.names.fields = fields;
        Err(enough())
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct
        seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'de> EnumAccess<'de> for Asker<'_> {
    type Error = Given;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Given> {
        let name = self.position.and_then(|position| self.names.variants.get(position)).ok_or_else(enough)?;
        let named: StrDeserializer<'_, Given> = name.into_deserializer();
        Ok((seed.deserialize(named)?, self))
    }
}

impl<'de> VariantAccess<'de> for Asker<'_> {
    type Error = Given;

    fn unit_variant(self) -> Result<(), Given> {
        Err(enough())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Given> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Given> {
        Err(enough())
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], _: V) -> Result<V::Value, Given> {
        self.names.fields = fields;
        Err(enough())
    }
}

/// Names of the fields of every command, by the command's name, as JSON.
#[pyfunction]
pub(crate) fn command_fields() -> PyResult<String> {
    let mut names = Names::default();
    // Each of these reads gives up; what was expected is noted.
    let _ = Command::deserialize(Asker { names: &mut names, position: None });
    let mut found = BTreeMap::new();
    for (position, variant) in names.variants.iter().enumerate() {
        let mut of_one = Names::default();
        let _ = Command::deserialize(Asker { names: &mut of_one, position: Some(position) });
        found.insert(*variant, of_one.fields);
    }
    serde_json::to_string(&found).map_err(wrong)
}
