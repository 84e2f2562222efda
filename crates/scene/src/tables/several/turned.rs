//! Weight, speeds and a region of output as a bearing that is turned sees them.

use assembly::Orientation;
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The direction of the weight in the bearing's frame.
pub fn turn_weight(document: &mut DocumentMut, orientation: Orientation) {
    // Getting a key of an item by itself would make it.
    let direction = document
        .get_mut("effects")
        .and_then(Item::as_table_like_mut)
        .and_then(|effects| effects.get_mut("gravity"))
        .and_then(Item::as_table_like_mut)
        .and_then(|gravity| gravity.get_mut("direction"))
        .and_then(Item::as_array_mut);
    let Some(direction) = direction else { return };
    let of = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    let numbers: Vec<f64> = direction.iter().filter_map(of).collect();
    if let [x, y, z] = numbers[..] {
        *direction = orientation
            .turned_vector([x, y, z])
            .map(|d| d + 0.0)
            .into_iter()
            .collect();
    }
}

/// Ends of the region of output in the bearing's frame: a half turn about x changes the signs of y, z and azimuths, and
/// so the order of the ends.
pub fn turn_region(document: &mut DocumentMut, orientation: Orientation) {
    if orientation == Orientation::PlusZ {
        return;
    }
    let region = document
        .get_mut("output")
        .and_then(Item::as_table_like_mut)
        .and_then(|output| output.get_mut("region"))
        .and_then(Item::as_table_like_mut);
    let Some(region) = region else { return };
    for key in ["azimuth", "y", "z"] {
        if let Some(ends) = region.get_mut(key).and_then(Item::as_array_mut) {
            let mut turned: Vec<Value> = ends.iter().cloned().collect();
            turned.iter_mut().for_each(turn_values);
            *ends = turned.into_iter().rev().collect();
        }
    }
}

/// Speeds in the bearing's frame: a spin along the shaft's z is one against the bearing's.
pub fn turn_speed(document: &mut DocumentMut, orientation: Orientation) {
    if orientation == Orientation::PlusZ {
        return;
    }
    let Some(speed) = document.get_mut("speed").and_then(Item::as_table_like_mut) else {
        return;
    };
    for ring in ["inner", "outer"] {
        match speed.get_mut(ring) {
            Some(Item::Value(value)) => turn_values(value),
            Some(Item::Table(table)) => {
                for key in ["values", "ramp"] {
                    match table.get_mut(key) {
                        Some(Item::Value(value)) => turn_values(value),
                        Some(Item::Table(ramp)) => turn_ends(ramp),
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
}

/// Turns a quantity, those of a list, or those in the inline table of a course over time.
fn turn_values(value: &mut Value) {
    match value {
        Value::String(text) => {
            let turned = match text.value().trim().strip_prefix('-') {
                Some(rest) => rest.to_string(),
                None => format!("-{}", text.value().trim().trim_start_matches('+')),
            };
            *value = Value::from(turned);
        }
        Value::Array(values) => values.iter_mut().for_each(turn_values),
        Value::InlineTable(table) => {
            if let Some(values) = table.get_mut("values") {
                turn_values(values);
            }
            if let Some(ramp) = table.get_mut("ramp").and_then(Value::as_inline_table_mut) {
                turn_ends(ramp);
            }
        }
        _ => {}
    }
}

/// Turns the speeds at both ends of a ramp.
fn turn_ends(ramp: &mut dyn TableLike) {
    for key in ["from", "to"] {
        if let Some(Item::Value(value)) = ramp.get_mut(key) {
            turn_values(value);
        }
    }
}

/// Speeds in the frame of the shaft of those of a bearing, or back.
pub fn turn_speeds(speeds: &mut dynamics::kinematics::RingSpeeds, orientation: Orientation) {
    for speed in [&mut speeds.inner, &mut speeds.outer] {
        speed
            .values
            .iter_mut()
            .for_each(|w| *w = orientation.turned_angle(*w));
    }
}
