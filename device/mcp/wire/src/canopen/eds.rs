//! The electronic data sheet (CiA 306) of a model and a firmware generation: what configuration tools and libraries read to know a
//! node's objects by name, made from the command table.
//!
//! Assumed: vendor, product and revision number, which no source gives (an MCP266 of generation 3 is product 266, revision 3 of
//! vendor 0, as the simulated node says), and the standard objects a real node has.

use std::fmt::Write as _;

use super::objects::{Shape, index_of, record_subindex_of, shape, subindex_of};
use crate::models::{Family, Model};
use crate::packet_serial::{COMMANDS, Command, Direction, Form, Generation};
use brushwork_values::{Field, Kind};

/// The vendor in the identity object. Assumed: not known, and 0 belongs to nobody.
pub const VENDOR: u32 = 0;

/// The rates a node can have, in kbit/s (MCP manual 1.9.4, whose second 500000 stands where 50000 belongs), of those that a data sheet
/// can name.
const RATES_KBPS: [u32; 7] = [10, 20, 50, 125, 250, 500, 800];
/// The highest of them, named by itself since a data sheet has it too.
const HIGHEST_RATE_KBPS: u32 = 1000;

/// Data types of CiA 301.
const U8: u16 = 0x05;
const U16: u16 = 0x06;
const U32: u16 = 0x07;
const TEXT: u16 = 0x09;

/// The product in the identity object: the digits of a model's name, 266 for the MCP266. Assumed.
#[must_use]
pub fn product_of(name: &str) -> u32 {
    let digits: String = name.chars().filter(char::is_ascii_digit).collect();
    digits.parse().unwrap_or(0)
}

/// The data sheet as text, with the line ends that the format asks for; `None` for a model that has no CAN port.
#[must_use]
pub fn data_sheet(model: &Model, generation: Generation) -> Option<String> {
    if model.family != Family::Mcp {
        return None;
    }
    let commands: Vec<Object> = COMMANDS
        .iter()
        .filter(|command| command.is_known_to(model.family))
        .filter_map(|command| object_of(command, command.form(generation)?))
        .collect();
    let mut sheet = Sheet(String::new());
    sheet.head(model, generation);
    let standard = standard_objects(model, generation);
    let (mandatory, optional): (Vec<_>, Vec<_>) =
        standard.into_iter().partition(|object| matches!(object.index, 0x1000 | 0x1001 | 0x1018));
    for (list, objects) in
        [("MandatoryObjects", mandatory), ("OptionalObjects", optional), ("ManufacturerObjects", commands)]
    {
        sheet.objects(list, &objects);
    }
    Some(sheet.0)
}

/// One object with its entries.
struct Object {
    index: u16,
    name: String,
    /// A single value, or the parts from subindex 1 on.
    entries: Entries,
}

enum Entries {
    Single(Entry),
    /// With the highest subindex in front.
    Parts(Vec<(u8, Entry)>),
}

struct Entry {
    name: String,
    data_type: u16,
    access: &'static str,
    range: Option<(i64, i64)>,
    value: Option<String>,
    comment: String,
}

impl Entry {
    fn new(name: &str, data_type: u16, access: &'static str) -> Self {
        Self { name: name.to_owned(), data_type, access, range: None, value: None, comment: String::new() }
    }

    fn with(self, value: String) -> Self {
        Self { value: Some(value), ..self }
    }

    fn of(field: &Field, name: &str, access: &'static str) -> Option<Self> {
        let data_type = match field.kind {
            Kind::I8 => 0x02,
            Kind::I16 => 0x03,
            Kind::I32 => 0x04,
            Kind::U8 => U8,
            Kind::U16 => U16,
            Kind::U32 => U32,
            Kind::U24 => 0x16,
            Kind::Text { .. } | Kind::Ascii36 | Kind::Utf16Le36 | Kind::Bytes(_) | Kind::Counted(_) => {
                return None;
            }
        };
        let entry = Self::new(name, data_type, access);
        Some(Self { range: field.raw_range, comment: field.doc.to_owned(), ..entry })
    }
}

fn object_of(command: &Command, form: &Form) -> Option<Object> {
    let access = match form.direction {
        Direction::Read => "ro",
        Direction::Write => "wo",
    };
    let name = capital(form.title.unwrap_or(command.title));
    let part = |at: u8, field: &Field, access| Some((at, Entry::of(field, &capital(field.name), access)?));
    let entries = match shape(form)? {
        Shape::Trigger => Entries::Single(Entry {
            comment: "write 0 to carry it out".to_owned(),
            range: Some((0, 0)),
            ..Entry::new(&name, U8, "wo")
        }),
        Shape::Single(field) => Entries::Single(Entry::of(field, &name, access)?),
        Shape::Several(fields) => {
            let parts = fields.iter().enumerate().map(|(at, field)| part(subindex_of(at), field, access));
            Entries::Parts(parts.collect::<Option<_>>()?)
        }
        Shape::Text => Entries::Parts(vec![(1, Entry::new("Text", TEXT, "ro"))]),
        Shape::List(fields) => {
            let chooser = Entry {
                comment:
                    "read: how many records there are; write: the record that is read from here on, from 0"
                        .to_owned(),
                ..Entry::new("Record", U8, "rw")
            };
            let parts =
                fields.iter().enumerate().map(|(at, field)| part(record_subindex_of(at), field, access));
            let rest: Vec<_> = parts.collect::<Option<_>>()?;
            Entries::Parts(std::iter::once((1, chooser)).chain(rest).collect())
        }
    };
    Some(Object { index: index_of(command.number), name, entries })
}

fn standard_objects(model: &Model, generation: Generation) -> Vec<Object> {
    use brushwork_canopen::nmt::objects;
    let single = |index, name: &str, entry: Entry| Object {
        index,
        name: name.to_owned(),
        entries: Entries::Single(Entry { name: name.to_owned(), ..entry }),
    };
    let identity = [
        ("Vendor-ID", Some(VENDOR)),
        ("Product code", Some(product_of(model.name))),
        ("Revision number", Some(u32::from(generation.number()))),
        ("Serial number", None),
    ];
    let identity = identity.into_iter().zip(1..).map(|((name, value), at)| {
        let entry = Entry::new(name, U32, "ro");
        (at, if let Some(value) = value { entry.with(value.to_string()) } else { entry })
    });
    let beat = Entry {
        comment: "bits 16 to 22: whose; low word: for how long, in ms".to_owned(),
        ..Entry::new("Consumer 1", U32, "rw")
    };
    vec![
        single(objects::DEVICE_TYPE, "Device type", Entry::new("", U32, "ro").with("0".to_owned())),
        single(objects::ERROR_REGISTER, "Error register", Entry::new("", U8, "ro")),
        single(
            objects::DEVICE_NAME,
            "Manufacturer device name",
            Entry::new("", TEXT, "const").with(model.title.to_owned()),
        ),
        single(objects::SOFTWARE_VERSION, "Manufacturer software version", Entry::new("", TEXT, "const")),
        Object {
            index: objects::CONSUMER_HEARTBEAT,
            name: "Consumer heartbeat time".to_owned(),
            entries: Entries::Parts(vec![(1, beat)]),
        },
        single(objects::PRODUCER_HEARTBEAT, "Producer heartbeat time", Entry::new("", U16, "rw")),
        Object {
            index: objects::IDENTITY,
            name: "Identity object".to_owned(),
            entries: Entries::Parts(identity.collect()),
        },
    ]
}

/// The text as it grows.
struct Sheet(String);

impl Sheet {
    fn line(&mut self, line: impl std::fmt::Display) {
        // Writing to a text does not fail.
        let _ = write!(self.0, "{line}\r\n");
    }

    fn section(&mut self, name: impl std::fmt::Display) {
        self.line("");
        self.line(format_args!("[{name}]"));
    }

    fn pairs(&mut self, pairs: &[(&str, String)]) {
        for (key, value) in pairs {
            self.line(format_args!("{key}={value}"));
        }
    }

    fn head(&mut self, model: &Model, generation: Generation) {
        self.line("[FileInfo]");
        let text = str::to_owned;
        self.pairs(&[
            ("FileName", format!("{}-generation{}.eds", model.key, generation.number())),
            ("FileVersion", text("1")),
            ("FileRevision", text("0")),
            ("EDSVersion", text("4.0")),
            ("Description", format!("{} with firmware of generation {}", model.name, generation.number())),
            ("CreationTime", text("12:00AM")),
            ("CreationDate", text("01-01-2026")),
            ("CreatedBy", text("Brushwork")),
            ("ModificationTime", text("12:00AM")),
            ("ModificationDate", text("01-01-2026")),
            ("ModifiedBy", text("Brushwork")),
        ]);
        self.section("DeviceInfo");
        self.pairs(&[
            ("VendorName", text("Basicmicro / Ion Motion Control")),
            ("VendorNumber", format!("0x{VENDOR:08X}")),
            ("ProductName", model.name.to_owned()),
            ("ProductNumber", product_of(model.name).to_string()),
            ("RevisionNumber", generation.number().to_string()),
            ("OrderCode", model.title.to_owned()),
        ]);
        for rate in RATES_KBPS.into_iter().chain([HIGHEST_RATE_KBPS]) {
            self.line(format_args!("BaudRate_{rate}=1"));
        }
        for (key, value) in [
            ("SimpleBootUpMaster", 0),
            ("SimpleBootUpSlave", 1),
            ("Granularity", 0),
            ("DynamicChannelsSupported", 0),
            ("CompactPDO", 0),
            ("GroupMessaging", 0),
            ("NrOfRXPDO", 0),
            ("NrOfTXPDO", 0),
            ("LSS_Supported", 0),
        ] {
            self.line(format_args!("{key}={value}"));
        }
        self.section("DummyUsage");
        (1..=7).for_each(|number| self.line(format_args!("Dummy000{number}=0")));
        self.section("Comments");
        self.line("Lines=3");
        self.line("Line1=Object 0x2000 + n is packet serial command n. A command without arguments is carried out by writing 0.");
        self.line("Line2=A command with several arguments is carried out when the last of them is written.");
        self.line(
            "Line3=Vendor, product and revision number are not known: they are those of a simulated node.",
        );
    }

    fn objects(&mut self, list: &str, objects: &[Object]) {
        self.section(list);
        self.line(format_args!("SupportedObjects={}", objects.len()));
        for (object, number) in objects.iter().zip(1..) {
            self.line(format_args!("{number}=0x{:04X}", object.index));
        }
        for object in objects {
            self.section(format_args!("{:04X}", object.index));
            match &object.entries {
                Entries::Single(entry) => self.entry(entry),
                Entries::Parts(parts) => self.record(object, parts),
            }
        }
    }

    fn record(&mut self, object: &Object, parts: &[(u8, Entry)]) {
        let highest = parts.last().map_or(0, |(at, _)| *at);
        self.line(format_args!("ParameterName={}", object.name));
        self.line("ObjectType=0x9");
        self.line(format_args!("SubNumber={}", parts.len() + 1));
        self.section(format_args!("{:04X}sub0", object.index));
        self.entry(&Entry::new("Highest subindex supported", U8, "ro").with(highest.to_string()));
        for (at, entry) in parts {
            self.section(format_args!("{:04X}sub{at:X}", object.index));
            self.entry(entry);
        }
    }

    fn entry(&mut self, entry: &Entry) {
        if !entry.comment.is_empty() {
            self.line(format_args!("; {}", entry.comment));
        }
        self.line(format_args!("ParameterName={}", entry.name));
        self.line("ObjectType=0x7");
        self.line(format_args!("DataType=0x{:04X}", entry.data_type));
        if let Some((low, high)) = entry.range {
            self.line(format_args!("LowLimit={low}"));
            self.line(format_args!("HighLimit={high}"));
        }
        self.line(format_args!("AccessType={}", entry.access));
        if let Some(value) = &entry.value {
            self.line(format_args!("DefaultValue={value}"));
        }
        self.line("PDOMapping=0");
    }
}

/// "duty_m1" and "read main battery" as names of objects: "Duty m1", "Read main battery".
fn capital(name: &str) -> String {
    let name = name.replace('_', " ");
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::{MODELS, lookup};
    use std::collections::BTreeSet;

    fn sheet(generation: Generation) -> String {
        data_sheet(lookup("mcp266").unwrap(), generation).unwrap()
    }

    #[test]
    fn every_object_of_the_table_is_in_the_sheet_of_its_generation_and_has_a_name_of_its_own() {
        for generation in Generation::ALL {
            let sheet = sheet(generation);
            let mut names = BTreeSet::new();
            for command in COMMANDS.iter().filter(|command| command.is_known_to(Family::Mcp)) {
                let has_object = command.form(generation).and_then(shape).is_some();
                let section = format!("\r\n[{:04X}]\r\n", index_of(command.number));
                assert_eq!(sheet.contains(&section), has_object, "{} in {generation}", command.key);
                if has_object {
                    let title = command.form(generation).and_then(|form| form.title).unwrap_or(command.title);
                    assert!(names.insert(title), "two objects are called {title} in {generation}");
                }
            }
            let listed = format!("[ManufacturerObjects]\r\nSupportedObjects={}\r\n", names.len());
            assert!(sheet.contains(&listed), "{generation}: {} objects", names.len());
        }
    }

    #[test]
    fn the_battery_is_a_word_to_read_and_a_duty_one_to_write() {
        let sheet = sheet(Generation::Gen1);
        let battery =
            "ParameterName=Read main battery\r\nObjectType=0x7\r\nDataType=0x0006\r\nAccessType=ro\r\n";
        assert!(sheet.contains(battery), "{sheet}");
        let duty = "DataType=0x0003\r\nLowLimit=-32767\r\nHighLimit=32767\r\nAccessType=wo\r\n";
        assert!(sheet.contains(duty), "{sheet}");
    }

    #[test]
    fn boards_without_a_can_port_have_none() {
        for model in MODELS {
            let has = data_sheet(model, Generation::Gen3).is_some();
            assert_eq!(has, model.family == Family::Mcp, "{}", model.key);
        }
    }
}
