/// A named moment of a clip: a foot is planted, a blow hits, a sword is drawn.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Marker {
    /// Name of the event. Several markers may have the same name.
    pub name: String,
    /// Seconds after the clip's first key frame, 0 to its duration.
    pub time: f64,
}
