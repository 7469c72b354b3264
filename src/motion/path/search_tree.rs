//! The search tree of flutter, tumbling and chaotic motion (thesis § 3.3.3, Fig. 3.7).

use super::database::{Entry, TrajectoryDatabase};
use super::segment::Glide;
use crate::motion::Regime;
use rand::{Rng, RngExt};
use rapier3d::na::Vector2;

/// A walk down the tree: at every turning point the body glides left or right.
///
/// Flutter takes the other branch at each level (gl, gr, gl, …), tumbling the same (gl, gl, …), chaotic
/// motion either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchTree {
    /// Feature vector of a regular glide to the right, in the database's units.
    pub feature: Vector2<f64>,
    /// Share of the class of a feature vector among which a segment is drawn, the nearest first.
    pub variety: f64,
}

impl SearchTree {
    /// Which branch a pattern takes after one, or `None` if it has no tree (steady descent, helix and
    /// spiral).
    pub fn branch(regime: Regime, last: Glide, random: &mut impl Rng) -> Option<Glide> {
        if !regime.has_search_tree() {
            return None;
        }
        Some(match regime {
            Regime::PeriodicFlutter => last.reversed(),
            Regime::TransitionalChaotic if random.random_bool(0.5) => last.reversed(),
            _ => last,
        })
    }

    /// The child of a node: a segment of the class that `scale` times the feature vector belongs to, the
    /// way it glides, near that vector ([`TrajectoryDatabase::find`]).
    pub fn child<'a>(
        &self,
        database: &'a TrajectoryDatabase,
        glide: Glide,
        scale: f64,
        random: &mut impl Rng,
    ) -> &'a Entry {
        let key = Vector2::new(glide.sign() * self.feature.x, self.feature.y) * scale;
        database.find(key, self.variety, random)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Glide::{Left, Right};
    use rand::SeedableRng;

    fn walk(regime: Regime, seed: u64, levels: usize) -> Vec<Glide> {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let mut walk = vec![Left];
        while walk.len() < levels {
            let last = walk[walk.len() - 1];
            walk.push(SearchTree::branch(regime, last, &mut random).unwrap());
        }
        walk
    }

    /// The walks are those of thesis Fig. 3.7 (2)–(4).
    #[test]
    fn four_levels() {
        assert_eq!(
            walk(Regime::PeriodicFlutter, 1, 4),
            [Left, Right, Left, Right]
        );
        assert_eq!(walk(Regime::PeriodicTumbling, 1, 4), [Left; 4]);
        // Chaotic motion turns back and over, about as often: within 5 standard deviations of ½.
        let chaotic = walk(Regime::TransitionalChaotic, 1, 1001);
        let backs = chaotic.windows(2).filter(|p| p[0] != p[1]).count();
        assert!((421..=579).contains(&backs), "{backs}");
    }

    #[test]
    fn children_glide_as_asked() {
        let database = TrajectoryDatabase::shipped();
        let tree = SearchTree {
            feature: Vector2::new(0.6, -3.1),
            variety: 0.0,
        };
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for scale in [0.1, 1.0, 10.0] {
            for glide in [Left, Right] {
                let found = tree.child(&database, glide, scale, &mut random).segment;
                assert_eq!(found.glide, glide);
                // It lies within a step of the database's ranges: 30^(1/9) across, 150^(1/32) down.
                let ratio = found.feature().component_div(&(tree.feature * scale));
                assert!((ratio.x.abs().ln() / 30f64.ln()).abs() < 1.0 / 9.0);
                assert!((ratio.y.ln() / 150f64.ln()).abs() < 1.0 / 32.0);
            }
        }
    }
}
