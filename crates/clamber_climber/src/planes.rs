use glam::DVec3;
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    pub(crate) offset: f64,
}
pub(crate) struct Above {
    pub(crate) point: DVec3,
    pub(crate) missed: f64,
}
pub(crate) fn nearest_above(target: DVec3, planes: &[Plane]) -> Above {
    let miss = |y: DVec3| {
        planes
            .iter()
            .map(|p| p.offset - p.normal.dot(y))
            .fold(0.0, f64::max)
    };
    let mut best: Option<(f64, DVec3)> = None;
    let mut offer = |y: DVec3| {
        if y.is_finite() && miss(y) <= 1e-9 {
            let d = y.distance(target);
            if best.is_none_or(|(b, _)| d < b) {
                best = Some((d, y));
            }
        }
    };
    offer(target);
    let n = planes.len();
    for i in 0..n {
        let p = planes[i];
        offer(target + p.normal * (p.offset - p.normal.dot(target)));
        for j in 0..i {
            let q = planes[j];
            let c = p.normal.dot(q.normal);
            let det = 1.0 - c * c;
            if det < 1e-12 {
                continue;
            }
            let (a, b) = (
                p.offset - p.normal.dot(target),
                q.offset - q.normal.dot(target),
            );
            offer(target + p.normal * ((a - c * b) / det) + q.normal * ((b - c * a) / det));
            for r in planes.iter().take(j) {
                let m = glam::DMat3::from_cols(p.normal, q.normal, r.normal).transpose();
                if m.determinant().abs() < 1e-9 {
                    continue;
                }
                offer(m.inverse() * DVec3::new(p.offset, q.offset, r.offset));
            }
        }
    }
    match best {
        Some((_, y)) => Above {
            point: y,
            missed: 0.0,
        },
        None => {
            let mut y = target;
            for _ in 0..64 {
                for p in planes {
                    let d = p.offset - p.normal.dot(y);
                    if d > 0.0 {
                        y += p.normal * d;
                    }
                }
            }
            Above {
                point: y,
                missed: miss(y),
            }
        }
    }
}
