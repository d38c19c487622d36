use std::fmt;
use std::str::FromStr;

use clamber_navigation::ClimbReport;

/// A condition on one number of the report, such as `weak_points>=3`.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// Index in [`NUMBERS`].
    number: usize,
    /// Index in [`ORDERS`].
    order: usize,
    wanted: f64,
}

/// A number of the report.
type Number = fn(&ClimbReport) -> f64;

/// The numbers by their names in a requirement.
const NUMBERS: [(&str, Number); 5] = [
    ("weak_points", |report| {
        let reachable = report.weak_points.iter().filter(|point| point.reachable);
        reachable.count() as f64
    }),
    ("reachable", |report| report.reachable_area / report.area),
    ("reachable_area", |report| report.reachable_area),
    ("rest_area", |report| report.rest_area),
    ("entries", |report| {
        report.ways_on.iter().map(|way| way.entries as f64).sum()
    }),
];

/// A comparison of the report's number with the wanted one.
type Order = fn(&f64, &f64) -> bool;

/// The comparison signs. `>=` and `<=` come before `>` and `<`, as the first sign found in the text is taken.
const ORDERS: [(&str, Order); 5] = [
    (">=", f64::ge),
    ("<=", f64::le),
    (">", f64::gt),
    ("<", f64::lt),
    ("=", f64::eq),
];

impl Requirement {
    /// The report's value of the required number.
    pub fn found(&self, report: &ClimbReport) -> f64 {
        NUMBERS[self.number].1(report)
    }

    /// True if the value `found` meets the requirement.
    pub fn holds(&self, found: f64) -> bool {
        ORDERS[self.order].1(&found, &self.wanted)
    }
}

impl FromStr for Requirement {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = ORDERS.iter().enumerate().find_map(|(order, (sign, _))| {
            let (name, wanted) = text.split_once(sign)?;
            Some((name.trim(), order, wanted.trim()))
        });
        let Some((name, order, wanted)) = split else {
            return Err("must be like weak_points>=3, with one of >=, <=, >, < and =".to_owned());
        };
        let number = NUMBERS.iter().position(|(known, _)| *known == name);
        let Some(number) = number else {
            let known: Vec<&str> = NUMBERS.iter().map(|(name, _)| *name).collect();
            return Err(format!("{name} is none of {}", known.join(", ")));
        };
        match wanted.parse::<f64>() {
            Ok(wanted) if wanted.is_finite() => Ok(Self {
                number,
                order,
                wanted,
            }),
            _ => Err(format!("{wanted} is not a number")),
        }
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, sign) = (NUMBERS[self.number].0, ORDERS[self.order].0);
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
