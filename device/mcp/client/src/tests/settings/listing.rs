//! The list of a controller's values.

use super::table;
use brushwork_link::settings::{SettingValue, list, list_text};
use brushwork_mcp_wire::packet_serial::Generation;

#[test]
fn the_list_marks_what_is_changed_unknown_or_locked() {
    let table = table("mcp266", Generation::Gen1);
    let mut image = table.default_image();
    image.set("motor1.velocity.p", SettingValue::Number(2.0));
    image.remove("motor2.velocity.qpps");
    let settings = list(&table, &image, false);
    let text = list_text(&settings);
    let line = |key: &str| {
        let start = format!("  {key} ");
        text.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("{key} in {text}"))
    };
    let words = |key: &str| line(key).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(words("motor1.velocity.p"), "motor1.velocity.p * 2.000 default 1.000");
    assert_eq!(words("motor2.velocity.qpps"), "motor2.velocity.qpps - default 44000 counts/s");
    assert_eq!(words("unit.bridge_channels"), "unit.bridge_channels # no default no");
    assert!(
        words("motor1.encoder.pin").ends_with("(counted from 0 in the pin list: DIN7/AN7/P7/ENC1A, assumed)")
    );
    assert!(text.starts_with("Unit settings\n  unit.address"), "{text}");
    let json = serde_json::to_value(&settings).expect("it is plain data");
    assert_eq!(json[0]["key"], "unit.address");
    assert_eq!(json[0]["value"], 128);
}
