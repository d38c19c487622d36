use glam::DVec3;

/// The contacts of one body with a climber in a step of a physics engine, summed up to make a
/// [`ProxyMeeting`](crate::ProxyMeeting). `B` and `C` are the engine's handles of bodies and colliders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyImpact<B, C> {
    /// The body that touches the climber.
    pub body: B,
    /// The body's collider with the strongest contacts.
    pub collider: C,
    /// Sum of the weights of that collider's contacts.
    strongest: f64,
    /// Sum of the weights of all contacts.
    weight: f64,
    /// Sums over all contacts of their point, normal and friction, each times the contact's weight.
    point: DVec3,
    normal: DVec3,
    friction: f64,
}

impl<B: Ord + Copy, C: Ord + Copy> ProxyImpact<B, C> {
    /// A collider of a body, without contacts.
    pub fn new(body: B, collider: C) -> Self {
        Self {
            body,
            collider,
            strongest: 0.0,
            weight: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::ZERO,
            friction: 0.0,
        }
    }

    /// Adds a contact of the collider. The contact counts by its `weight`, the engine's impulse. `normal` is the unit
    /// vector from the climber to the body, `friction` the coefficient of friction there or an upper bound of it.
    pub fn add(&mut self, weight: f64, point: DVec3, normal: DVec3, friction: f64) {
        self.strongest += weight;
        self.weight += weight;
        self.point += point * weight;
        self.normal += normal * weight;
        self.friction += friction * weight;
    }

    /// True if there is a contact with a weight.
    pub fn touches(&self) -> bool {
        self.weight > 0.0
    }

    /// Merges the impacts of all colliders of a body into one, in ascending order of the bodies. The order in which the
    /// engine found the impacts does not matter.
    pub fn merge(impacts: &mut Vec<Self>) {
        impacts.sort_unstable_by_key(|impact| (impact.body, impact.collider));
        impacts.dedup_by(|next, first| {
            let is_same = next.body == first.body;
            if is_same {
                first.weight += next.weight;
                first.point += next.point;
                first.normal += next.normal;
                first.friction += next.friction;
                if next.strongest > first.strongest {
                    (first.collider, first.strongest) = (next.collider, next.strongest);
                }
            }
            is_same
        });
    }

    /// The weighted mean of the contacts' points, in the space of the points that were added. Not finite unless the
    /// impact [touches](Self::touches).
    pub fn point(&self) -> DVec3 {
        self.point / self.weight
    }

    /// The unit vector from the climber to the body; `None` if the contacts' normals cancel out.
    pub fn normal(&self) -> Option<DVec3> {
        self.normal.try_normalize()
    }

    /// The mean coefficient of friction. Not finite unless the impact [touches](Self::touches).
    pub fn friction(&self) -> f64 {
        self.friction / self.weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn impact(body: u32, collider: u32, weights: &[f64]) -> ProxyImpact<u32, u32> {
        let mut impact = ProxyImpact::new(body, collider);
        for weight in weights {
            impact.add(*weight, DVec3::X * f64::from(collider), DVec3::Y, 0.5);
        }
        impact
    }

    #[test]
    fn the_colliders_of_a_body_are_one_impact_in_any_order() {
        let all = [
            impact(2, 5, &[1.0]),
            impact(1, 3, &[2.0, 2.0]),
            impact(2, 4, &[1.0, 2.0]),
            impact(1, 9, &[1.0]),
        ];
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            let mut merged = order.map(|index| all[index]).to_vec();
            ProxyImpact::merge(&mut merged);
            let told = merged.iter().map(|impact| (impact.body, impact.collider));
            assert_eq!(told.collect::<Vec<_>>(), [(1, 3), (2, 4)]);
            assert_eq!(merged[0].point(), DVec3::X * (3.0 * 4.0 + 9.0) / 5.0);
            assert_eq!(merged[1].point(), DVec3::X * (5.0 + 3.0 * 4.0) / 4.0);
            assert_eq!(merged[0].normal(), Some(DVec3::Y));
            assert_eq!(merged[0].friction(), 0.5);
        }
    }

    #[test]
    fn what_has_no_weight_does_not_touch() {
        assert!(!impact(0, 0, &[]).touches() && !impact(0, 0, &[0.0]).touches());
        assert!(impact(0, 0, &[1e-300]).touches());
        let mut opposite = impact(0, 0, &[1.0]);
        opposite.add(1.0, DVec3::ZERO, DVec3::NEG_Y, 0.5);
        assert_eq!(opposite.normal(), None);
    }
}
