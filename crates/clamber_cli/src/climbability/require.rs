use std::fmt;
use std::str::FromStr;

use clamber_navigation::ClimbReport;

/// A condition on one number of the report, such as `weak_points>=3`.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    number: Number,
    order: Order,
    wanted: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    WeakPoints,
    Reachable,
    ReachableArea,
    RestArea,
    Entries,
}

/// The numbers by their names in a requirement.
const NUMBERS: [(&str, Number); 5] = [
    ("weak_points", Number::WeakPoints),
    ("reachable", Number::Reachable),
    ("reachable_area", Number::ReachableArea),
    ("rest_area", Number::RestArea),
    ("entries", Number::Entries),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    AtLeast,
    AtMost,
    Above,
    Below,
    Is,
}

/// The comparison signs. `>=` and `<=` come before `>` and `<`, as the first sign found in the text is taken.
const ORDERS: [(&str, Order); 5] = [
    (">=", Order::AtLeast),
    ("<=", Order::AtMost),
    (">", Order::Above),
    ("<", Order::Below),
    ("=", Order::Is),
];

impl Requirement {
    /// The report's value of the required number.
    pub fn found(&self, report: &ClimbReport) -> f64 {
        match self.number {
            Number::WeakPoints => {
                let reachable = report.weak_points.iter().filter(|point| point.reachable);
                reachable.count() as f64
            }
            Number::Reachable => report.reachable_area / report.area,
            Number::ReachableArea => report.reachable_area,
            Number::RestArea => report.rest_area,
            Number::Entries => report.ways_on.iter().map(|way| way.entries as f64).sum(),
        }
    }

    /// True if the value `found` meets the requirement.
    pub fn holds(&self, found: f64) -> bool {
        match self.order {
            Order::AtLeast => found >= self.wanted,
            Order::AtMost => found <= self.wanted,
            Order::Above => found > self.wanted,
            Order::Below => found < self.wanted,
            Order::Is => found == self.wanted,
        }
    }
}

impl FromStr for Requirement {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = ORDERS.iter().find_map(|(sign, order)| {
            let (name, wanted) = text.split_once(sign)?;
            Some((name.trim(), *order, wanted.trim()))
        });
        let Some((name, order, wanted)) = split else {
            return Err("must be like weak_points>=3, with one of >=, <=, >, < and =".to_owned());
        };
        let number = NUMBERS.iter().find(|(known, _)| *known == name);
        let Some((_, number)) = number else {
            let known: Vec<&str> = NUMBERS.iter().map(|(name, _)| *name).collect();
            return Err(format!("{name} is none of {}", known.join(", ")));
        };
        match wanted.parse::<f64>() {
            Ok(wanted) if wanted.is_finite() => Ok(Self {
                number: *number,
                order,
                wanted,
            }),
            _ => Err(format!("{wanted} is not a number")),
        }
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = NUMBERS.iter().find(|(_, number)| *number == self.number);
        let sign = ORDERS.iter().find(|(_, order)| *order == self.order);
        let (name, sign) = (
            name.map_or("", |name| name.0),
            sign.map_or("", |sign| sign.0),
        );
        write!(f, "{name}{sign}{}", self.wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requirements_are_read_as_they_are_written() {
        for text in [
            "weak_points>=3",
            "reachable>0.5",
            "entries=4",
            "rest_area<=10",
        ] {
            let requirement: Requirement = text.parse().unwrap();
            assert_eq!(requirement.to_string(), text);
        }
        let spaced: Requirement = " reachable_area < 12.5 ".parse().unwrap();
        assert_eq!(spaced.to_string(), "reachable_area<12.5");
        assert!(spaced.holds(12.0) && !spaced.holds(12.5));
        for wrong in [
            "weak_points",
            "legs>=2",
            "entries>=many",
            "entries>=inf",
            "",
        ] {
            assert!(wrong.parse::<Requirement>().is_err(), "{wrong}");
        }
    }
}
