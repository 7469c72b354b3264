//! A block of numbers with one layer of ghosts around it, interpolated linearly.

/// Values at lattice nodes 0..dims along each axis, and ghosts at −1 and dims.
///
/// An axis with one cell is inactive: it has no ghosts, and nothing varies along it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array3 {
    pub dims: [usize; 3],
    pad: [usize; 3],
    pub stride: [usize; 3],
    pub data: Vec<f64>,
}

impl Array3 {
    pub fn new(dims: [usize; 3], active: [bool; 3]) -> Self {
        let pad = active.map(usize::from);
        let full: [usize; 3] = core::array::from_fn(|i| dims[i] + 2 * pad[i]);
        Self {
            dims,
            pad,
            stride: [1, full[0], full[0] * full[1]],
            data: vec![0.0; full.iter().product()],
        }
    }

    /// Position in `data` of node `index`; add or subtract a stride for a neighbor.
    #[inline]
    pub fn position(&self, index: [usize; 3]) -> usize {
        (0..3)
            .map(|i| (index[i] + self.pad[i]) * self.stride[i])
            .sum()
    }

    #[inline]
    pub fn get(&self, index: [usize; 3]) -> f64 {
        self.data[self.position(index)]
    }

    #[inline]
    pub fn set(&mut self, index: [usize; 3], value: f64) {
        let position = self.position(index);
        self.data[position] = value;
    }

    /// Number of nodes without ghosts.
    pub fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// Indices of all nodes, x fastest.
    pub fn indices(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.dims;
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
    }

    /// Corner and weights of the cell around `x` (in nodes), kept inside nodes and ghosts.
    #[inline]
    fn cell(&self, x: [f64; 3]) -> (usize, [f64; 3]) {
        let mut corner = 0;
        let mut weight = [0.0; 3];
        for i in 0..3 {
            if self.pad[i] == 1 {
                let last = self.dims[i] as f64;
                let x = (x[i] + 1.0).clamp(0.0, last + 1.0);
                let below = (x as usize).min(self.dims[i]);
                corner += below * self.stride[i];
                weight[i] = x - below as f64;
            }
        }
        (corner, weight)
    }

    /// Linear interpolation at `x`, in nodes, clamped to the ghosts.
    #[inline]
    pub fn sample(&self, x: [f64; 3]) -> f64 {
        let (corner, w) = self.cell(x);
        let mix = |a: f64, b: f64, w: f64| a + (b - a) * w;
        // Every kind of grid has a loop of its own, because the solver spends its time here.
        let [_, row, plane] = self.stride;
        let line = |at: usize| {
            let pair = &self.data[at..at + 2];
            mix(pair[0], pair[1], w[0])
        };
        match self.pad {
            [1, 1, 1] => {
                let low = mix(line(corner), line(corner + row), w[1]);
                let corner = corner + plane;
                mix(low, mix(line(corner), line(corner + row), w[1]), w[2])
            }
            [1, 1, 0] => mix(line(corner), line(corner + row), w[1]),
            _ => {
                // Weights are zero along inactive axes.
                (0..8)
                    .filter(|n| (0..3).all(|i| n >> i & 1 <= self.pad[i]))
                    .map(|n| {
                        let at: usize = (0..3).map(|i| (n >> i & 1) * self.stride[i]).sum();
                        let weight: f64 = (0..3)
                            .map(|i| if n >> i & 1 == 1 { w[i] } else { 1.0 - w[i] })
                            .product();
                        weight * self.data[corner + at]
                    })
                    .sum()
            }
        }
    }

    /// Smallest and largest of the values that [`Array3::sample`] would mix.
    pub fn range(&self, x: [f64; 3]) -> (f64, f64) {
        let (corner, _) = self.cell(x);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for n in 0..8 {
            if (0..3).any(|i| n >> i & 1 > self.pad[i]) {
                continue;
            }
            let offset: usize = (0..3).map(|i| (n >> i & 1) * self.stride[i]).sum();
            let value = self.data[corner + offset];
            low = low.min(value);
            high = high.max(value);
        }
        (low, high)
    }

    /// Sets the ghosts on one side of `axis` from the node `from` of the same line: ghost = `offset` +
    /// `factor`·node.
    pub fn fill_ghosts(
        &mut self,
        axis: usize,
        upper: bool,
        from: usize,
        factor: f64,
        offset: impl Fn([usize; 3]) -> f64,
    ) {
        let ghost = if upper { self.dims[axis] + 1 } else { 0 };
        let source = from + 1;
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        // Edges and corners are filled too, so that interpolation next to them is sane.
        let full = |i: usize| self.dims[i] + 2 * self.pad[i];
        for m in 0..full(a) {
            for n in 0..full(b) {
                let base = m * self.stride[a] + n * self.stride[b];
                let mut index = [0; 3];
                index[a] = m.saturating_sub(self.pad[a]).min(self.dims[a] - 1);
                index[b] = n.saturating_sub(self.pad[b]).min(self.dims[b] - 1);
                let value = self.data[base + source * self.stride[axis]];
                self.data[base + ghost * self.stride[axis]] = offset(index) + factor * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_exact_for_linear_fields_in_two_and_three_dimensions() {
        for dims in [[5, 4, 1], [5, 4, 3], [5, 1, 3], [1, 4, 1]] {
            let active = dims.map(|n| n > 1);
            let mut array = Array3::new(dims, active);
            let value = |x: [f64; 3]| 1.0 + 2.0 * x[0] - 3.0 * x[1] + 0.5 * x[2];
            for index in array.indices() {
                array.set(index, value(index.map(|i| i as f64)));
            }
            let x = [2.25, 0.75, 1.3];
            let x: [f64; 3] = core::array::from_fn(|i| if dims[i] > 1 { x[i] } else { 0.0 });
            assert!((array.sample(x) - value(x)).abs() < 1.0e-12);
            let (low, high) = array.range(x);
            assert!(low < array.sample(x) && array.sample(x) < high);
            // Far outside it stays within the memory that it owns.
            assert!(array.sample([1.0e9, -1.0e9, 1.0e9]).is_finite());
        }
    }
}
