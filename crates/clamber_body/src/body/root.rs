use glam::{DMat3, DQuat, DVec3};

/// The model's place in the world. Its origin is between the feet. Lengths are metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Root {
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
}

impl Root {
    pub(crate) fn point(&self, model: DVec3) -> DVec3 {
        self.position + self.rotation * model
    }

    pub(crate) fn inverse_point(&self, world: DVec3) -> DVec3 {
        self.rotation.conjugate() * (world - self.position)
    }

    /// The root that takes the point `model` of the model to the point `world`.
    pub(crate) fn with_point_at(model: DVec3, world: DVec3, rotation: DQuat) -> Self {
        let position = world - rotation * model;
        Self { position, rotation }
    }
}

/// The rotation that takes Y exactly to `above`, and a figure's `facing` as near as possible to `ahead`.
pub(crate) fn facing_to(facing: DVec3, ahead: DVec3, above: DVec3) -> DQuat {
    let above = above.normalize_or(DVec3::Y);
    let ahead = (ahead - above * ahead.dot(above)).normalize_or(above.any_orthonormal_vector());
    let world = DMat3::from_cols(above.cross(ahead), above, ahead);
    let model = DMat3::from_cols(DVec3::Y.cross(facing), DVec3::Y, facing);
    DQuat::from_mat3(&(world * model.transpose())).normalize()
}
