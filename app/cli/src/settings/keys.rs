//! Keys and values as they are typed, against the table: what they mean, or what is wrong with them.

use brushwork_link::settings::{SettingsImage, SettingsTable};

use super::args::Assignment;

/// How alike a key must be to be suggested; 1 is the same.
const LIKENESS: f64 = 0.7;

/// What the assignments ask for.
///
/// # Errors
/// A sentence for each one that asks for nothing that can be.
pub fn parse(table: &SettingsTable, assignments: &[Assignment]) -> Result<SettingsImage, Vec<String>> {
    let mut wanted = SettingsImage::default();
    let mut problems = Vec::new();
    for Assignment { key, value } in assignments {
        let parsed = match table.row(key) {
            None => Err(unknown(table, key)),
            Some(_) if wanted.get(key).is_some() => Err(format!("{key} is given twice.")),
            Some(row) => row.parse(value).map_err(|why| why.to_string()),
        };
        match parsed {
            Ok(value) => wanted.set(key, value),
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() { Ok(wanted) } else { Err(problems) }
}

/// The first of `starts` that no key begins with, as a sentence.
pub fn unmatched(table: &SettingsTable, starts: &[String]) -> Option<String> {
    let nowhere = |start: &&String| !table.rows().iter().any(|row| begins_with(&row.key, start));
    starts.iter().find(nowhere).map(|start| unknown(table, start))
}

/// Whether `key` is `start` or lies under it: "motor1" has "motor1.encoder.pin" under it and "pin.1" does not
/// have "pin.10".
pub fn begins_with(key: &str, start: &str) -> bool {
    let start = start.trim_end_matches('.');
    key.strip_prefix(start).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// A sentence about a key that the controller does not have, with the one that may have been meant.
fn unknown(table: &SettingsTable, key: &str) -> String {
    let subject = table.subject();
    let missing =
        format!("The {} with firmware {} has no setting {key}.", subject.model.name, subject.generation);
    match closest(table, key) {
        Some(closest) => format!("{missing} Did you mean {closest}?"),
        None => format!("{missing} `brushwork settings read` lists those it has."),
    }
}

fn closest<'t>(table: &'t SettingsTable, key: &str) -> Option<&'t str> {
    let key = key.to_lowercase();
    let rows =
        table.rows().iter().map(|row| (strsim::normalized_damerau_levenshtein(&row.key, &key), &*row.key));
    rows.filter(|(likeness, _)| *likeness >= LIKENESS)
        .max_by(|left, right| left.0.total_cmp(&right.0))
        .map(|(_, key)| key)
}

#[cfg(test)]
mod tests {
    use brushwork_link::settings::SettingValue;
    use brushwork_mcp_wire::models;
    use brushwork_mcp_wire::packet_serial::Generation;

    use super::*;

    fn table() -> SettingsTable {
        brushwork_link::register(&brushwork_mcp_client::McpDriver);
        let model = models::lookup("mcp266").expect("it is in the list");
        brushwork_link::register(&brushwork_mcp_client::McpDriver);
        SettingsTable::new(brushwork_mcp_client::subject(model, Generation::Gen1))
    }

    fn typed(texts: &[&str]) -> Vec<Assignment> {
        texts.iter().map(|text| text.parse().unwrap()).collect()
    }

    #[test]
    fn values_are_taken_in_the_unit_of_their_setting() {
        let wanted =
            parse(&table(), &typed(&["motor1.velocity.p=2.5", "motor2.velocity.qpps = 9000"])).unwrap();
        assert_eq!(wanted.get("motor1.velocity.p"), Some(SettingValue::Number(2.5)));
        assert_eq!(wanted.get("motor2.velocity.qpps"), Some(SettingValue::Int(9000)));
    }

    #[test]
    fn every_fault_is_named_and_a_slip_of_the_finger_is_mended() {
        let faults = parse(
            &table(),
            &typed(&[
                "motor1.velocty.p=1",
                "motor1.velocity.p=x",
                "zzz=1",
                "motor1.velocity.i=1",
                "motor1.velocity.i=2",
            ]),
        )
        .unwrap_err();
        assert_eq!(faults.len(), 4, "{faults:#?}");
        assert!(faults[0].ends_with("Did you mean motor1.velocity.p?"), "{}", faults[0]);
        assert!(faults[1].contains("'x' is not a number"), "{}", faults[1]);
        assert!(faults[2].contains("lists those it has"), "{}", faults[2]);
        assert_eq!(faults[3], "motor1.velocity.i is given twice.");
    }

    #[test]
    fn a_start_ends_at_a_dot() {
        assert!(begins_with("pin.1.type", "pin.1"));
        assert!(begins_with("pin.1.type", "pin."));
        assert!(!begins_with("pin.10.type", "pin.1"));
        assert_eq!(unmatched(&table(), &["motor1".to_owned()]), None);
        assert!(unmatched(&table(), &["motor7".to_owned()]).is_some());
    }

    #[test]
    fn what_is_no_key_and_value_is_refused() {
        for text in ["motor1.velocity.p", "=3", " = "] {
            assert!(text.parse::<Assignment>().is_err(), "{text}");
        }
    }
}
