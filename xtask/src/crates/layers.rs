//! Arranges boxes in layers: their order within a layer, and their positions.
//!
//! An arrow that passes a layer bends there, and the bend takes a position among the boxes, without a width. Within a
//! layer, boxes and bends are sorted by the mean rank of their neighbours in the layer below, then in the layer above,
//! repeatedly. The order with the fewest crossings is kept (Sugiyama, Tagawa, Toda 1981, "Methods for Visual
//! Understanding of Hierarchical System Structures"). Then each box moves towards the mean position of its neighbours.
//! All numbers are integers, so the result is the same on every machine.

/// Number of sweeps through all layers that sort them. The order of a few dozen crates no longer changes after some ten
/// sweeps.
const SWEEPS: usize = 24;

/// Number of sweeps through all layers that move boxes towards their neighbours.
const PULLS: usize = 40;

/// Gap between neighbours in a layer, pixels.
const GAP: i32 = 28;

/// Resolution of mean ranks, parts of a rank: a common multiple of 1 to 10, so that means of up to ten neighbours are
/// exact.
const FINE: usize = 2520;

/// A box, or a bend of an arrow.
#[derive(Clone, Copy, Debug)]
struct Slot {
    layer: usize,
    width: i32,
}

/// Boxes and bends in layers, layer 0 at the bottom, and the legs of arrows between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layers {
    slots: Vec<Slot>,
    /// Slots of each layer, from left to right.
    rows: Vec<Vec<usize>>,
    /// Legs of arrows, each from a slot to a slot in the layer below.
    legs: Vec<(usize, usize)>,
}

/// The arrangement of all slots, in pixels.
#[derive(Clone, Debug)]
pub(crate) struct Arranged {
    /// Width of the whole arrangement.
    pub(crate) width: i32,
    /// Number of layers.
    pub(crate) layers: i32,
    /// For each slot, the distance of its middle from the left edge, and its layer.
    pub(crate) places: Vec<(i32, i32)>,
}

/// The layer below or the layer above a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Below,
    Above,
}

impl Layers {
    /// Adds a box, or a bend if `width` is 0, at the right end of a layer; returns its slot.
    pub(crate) fn add(&mut self, layer: usize, width: i32) -> usize {
        if self.rows.len() <= layer {
            self.rows.resize_with(layer + 1, Vec::new);
        }
        let slot = self.slots.len();
        self.slots.push(Slot { layer, width });
        self.rows[layer].push(slot);
        slot
    }

    /// Adds a leg of an arrow, from a slot to a slot in the layer below.
    pub(crate) fn connect(&mut self, from: usize, to: usize) {
        self.legs.push((from, to));
    }

    /// Sorts the layers and positions all slots.
    pub(crate) fn arrange(mut self) -> Arranged {
        self.sort();
        let middles = self.middles();
        let reach = |slot: usize| self.slots[slot].width / 2;
        let edges = middles.iter().enumerate();
        let left = edges.clone().map(|(slot, x)| x - reach(slot)).min();
        let right = edges.map(|(slot, x)| x + reach(slot)).max();
        let (left, right) = (left.unwrap_or(0), right.unwrap_or(0));
        let places = middles.iter().zip(&self.slots);
        Arranged {
            width: right - left,
            layers: self.rows.len() as i32,
            places: places
                .map(|(x, slot)| (x - left, slot.layer as i32))
                .collect(),
        }
    }

    /// Sorts each layer for few crossings of legs.
    fn sort(&mut self) {
        let mut rows = self.rows.clone();
        let mut fewest = self.crossings(&rows);
        for sweep in 0..SWEEPS {
            let (side, order) = self.sweep(sweep);
            for layer in order {
                let ranks = self.ranks(&rows);
                rows[layer].sort_by_cached_key(|slot| {
                    let near = self.neighbours(*slot, side);
                    match near.len() {
                        0 => ranks[*slot] * FINE,
                        count => near.iter().map(|slot| ranks[*slot]).sum::<usize>() * FINE / count,
                    }
                });
            }
            let crossings = self.crossings(&rows);
            if crossings < fewest {
                fewest = crossings;
                self.rows.clone_from(&rows);
            }
        }
    }

    /// The side whose neighbours a sweep uses, and the order of its layers: upwards in even sweeps, downwards in odd
    /// ones.
    fn sweep(&self, sweep: usize) -> (Side, Vec<usize>) {
        let layers = 0..self.rows.len();
        if sweep.is_multiple_of(2) {
            (Side::Below, layers.collect())
        } else {
            (Side::Above, layers.rev().collect())
        }
    }

    /// The slots in the layer on one side that are connected with a slot.
    fn neighbours(&self, slot: usize, side: Side) -> Vec<usize> {
        let legs = self.legs.iter().filter_map(|(from, to)| match side {
            Side::Below => (*from == slot).then_some(*to),
            Side::Above => (*to == slot).then_some(*from),
        });
        legs.collect()
    }

    /// The index of each slot in its layer.
    fn ranks(&self, rows: &[Vec<usize>]) -> Vec<usize> {
        let mut ranks = vec![0; self.slots.len()];
        for row in rows {
            for (rank, slot) in row.iter().enumerate() {
                ranks[*slot] = rank;
            }
        }
        ranks
    }

    /// The number of pairs of legs that cross.
    fn crossings(&self, rows: &[Vec<usize>]) -> usize {
        let ranks = self.ranks(rows);
        let mut crossings = 0;
        for (index, (a, b)) in self.legs.iter().enumerate() {
            for (c, d) in &self.legs[..index] {
                let above = ranks[*a].cmp(&ranks[*c]);
                let below = ranks[*b].cmp(&ranks[*d]);
                let is_beside = self.slots[*a].layer == self.slots[*c].layer;
                crossings += usize::from(is_beside && above.is_ne() && above == below.reverse());
            }
        }
        crossings
    }

    /// The position of each slot's middle, pixels.
    fn middles(&self) -> Vec<i32> {
        let mut middles = vec![0; self.slots.len()];
        for row in &self.rows {
            for pair in row.windows(2) {
                middles[pair[1]] = middles[pair[0]] + self.apart(pair[0], pair[1]);
            }
        }
        for sweep in 0..PULLS {
            for layer in self.sweep(sweep).1 {
                let row = &self.rows[layer];
                let wanted: Vec<i32> = row.iter().map(|slot| self.pull(*slot, &middles)).collect();
                for (slot, middle) in row.iter().zip(self.spread(row, &wanted)) {
                    middles[*slot] = middle;
                }
            }
        }
        middles
    }

    /// The mean position of a slot's neighbours on both sides, pixels.
    fn pull(&self, slot: usize, middles: &[i32]) -> i32 {
        let [above, below] = [Side::Above, Side::Below].map(|side| self.neighbours(slot, side));
        let near = above.iter().chain(&below);
        let sum: i32 = near.clone().map(|slot| middles[*slot]).sum();
        match near.count() {
            0 => middles[slot],
            count => sum.div_euclid(count as i32),
        }
    }

    /// Positions of a row, near the wanted ones and far enough apart: the mean of a row that is pushed to the right and
    /// a row that is pushed to the left.
    fn spread(&self, row: &[usize], wanted: &[i32]) -> Vec<i32> {
        let (mut rightward, mut leftward) = (wanted.to_vec(), wanted.to_vec());
        for k in 1..row.len() {
            let least = rightward[k - 1] + self.apart(row[k - 1], row[k]);
            rightward[k] = rightward[k].max(least);
        }
        for k in (1..row.len()).rev() {
            let most = leftward[k] - self.apart(row[k - 1], row[k]);
            leftward[k - 1] = leftward[k - 1].min(most);
        }
        let both = rightward.iter().zip(&leftward);
        both.map(|(a, b)| (a + b).div_euclid(2)).collect()
    }

    /// Least distance between the middles of neighbours in a layer, pixels.
    fn apart(&self, left: usize, right: usize) -> i32 {
        (self.slots[left].width + self.slots[right].width) / 2 + GAP
    }
}

#[cfg(test)]
mod tests {
    use super::{GAP, Layers};

    #[test]
    fn two_arrows_that_cross_are_laid_side_by_side() {
        let mut layers = Layers::default();
        let [a, b] = [0, 0].map(|layer| layers.add(layer, 100));
        let [c, d] = [1, 1].map(|layer| layers.add(layer, 100));
        layers.connect(c, b);
        layers.connect(d, a);
        let arranged = layers.arrange();
        let x = |slot: usize| arranged.places[slot].0;
        assert_eq!((x(c), x(d)), (x(b), x(a)), "{arranged:?}");
        assert_eq!((x(a) - x(b)).abs(), 100 + GAP, "{arranged:?}");
        assert_eq!((arranged.width, arranged.layers), (200 + GAP, 2));
    }
}
