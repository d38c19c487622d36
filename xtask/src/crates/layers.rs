//! Boxes in layers: their order within a layer, and their places.
//!
//! An arrow that passes a layer bends there, and the bend takes a place among the boxes, without a width. Within a
//! layer, boxes and bends are sorted by the mean rank of their neighbours in the layer below, then in the one above,
//! again and again, and the order with the fewest crossings is kept (Sugiyama, Tagawa, Toda 1981, "Methods for Visual
//! Understanding of Hierarchical System Structures"). Then each is drawn to the mean place of its neighbours. All of it
//! is in whole numbers, so the result is the same everywhere.

/// Sweeps through all layers that look for a better order. The order of a few dozen crates no longer changes after
/// some ten.
const SWEEPS: usize = 24;

/// Sweeps through all layers that draw boxes to their neighbours.
const PULLS: usize = 40;

/// Distance between neighbours in a layer.
const GAP: i32 = 28;

/// Fractions of a rank that are told apart: a multiple of all counts of neighbours up to ten.
const FINE: usize = 2520;

/// A box or a bend.
#[derive(Clone, Copy, Debug)]
struct Slot {
    layer: usize,
    width: i32,
}

/// Boxes and bends in layers, layer 0 at the bottom, and the legs of arrows between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layers {
    slots: Vec<Slot>,
    /// The slots of each layer, from left to right.
    rows: Vec<Vec<usize>>,
    /// From a slot to one in the layer below.
    legs: Vec<(usize, usize)>,
}

/// Where everything is.
#[derive(Clone, Debug)]
pub(crate) struct Arranged {
    /// Width of the whole.
    pub(crate) width: i32,
    /// Number of layers.
    pub(crate) layers: i32,
    /// For each slot, the distance of its middle from the left edge, and its layer.
    pub(crate) places: Vec<(i32, i32)>,
}

/// The layer below or the layer above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Below,
    Above,
}

impl Layers {
    /// Adds a box, or with a width of 0 a bend, at the right end of a layer; returns its slot.
    pub(crate) fn add(&mut self, layer: usize, width: i32) -> usize {
        if self.rows.len() <= layer {
            self.rows.resize_with(layer + 1, Vec::new);
        }
        let slot = self.slots.len();
        self.slots.push(Slot { layer, width });
        self.rows[layer].push(slot);
        slot
    }

    /// Adds a leg of an arrow, from a slot to one in the layer below.
    pub(crate) fn connect(&mut self, from: usize, to: usize) {
        self.legs.push((from, to));
    }

    /// Sorts the layers and places everything.
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

    /// Sorts each layer, so that few legs cross.
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

    /// The side to which a sweep looks, and the order in which it takes the layers: upwards, then downwards.
    fn sweep(&self, sweep: usize) -> (Side, Vec<usize>) {
        let layers = 0..self.rows.len();
        if sweep.is_multiple_of(2) {
            (Side::Below, layers.collect())
        } else {
            (Side::Above, layers.rev().collect())
        }
    }

    /// The slots that a slot has legs to, in the layer on one side.
    fn neighbours(&self, slot: usize, side: Side) -> Vec<usize> {
        let legs = self.legs.iter().filter_map(|(from, to)| match side {
            Side::Below => (*from == slot).then_some(*to),
            Side::Above => (*to == slot).then_some(*from),
        });
        legs.collect()
    }

    /// For each slot, its number in its layer.
    fn ranks(&self, rows: &[Vec<usize>]) -> Vec<usize> {
        let mut ranks = vec![0; self.slots.len()];
        for row in rows {
            for (rank, slot) in row.iter().enumerate() {
                ranks[*slot] = rank;
            }
        }
        ranks
    }

    /// How many pairs of legs cross.
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

    /// For each slot, the place of its middle.
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

    /// The mean place of a slot's neighbours on both sides.
    fn pull(&self, slot: usize, middles: &[i32]) -> i32 {
        let [above, below] = [Side::Above, Side::Below].map(|side| self.neighbours(slot, side));
        let near = above.iter().chain(&below);
        let sum: i32 = near.clone().map(|slot| middles[*slot]).sum();
        match near.count() {
            0 => middles[slot],
            count => sum.div_euclid(count as i32),
        }
    }

    /// Places of a row, near the wanted ones and far enough apart: the mean of a row that was pushed to the right and
    /// of one that was pushed to the left.
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

    /// The least distance between the middles of neighbours in a layer.
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
