//! What an encoder hides of a window in which it stays within one of its steps.

use super::Board;

/// Within so many steps it shows one step at most.
const ONE: f64 = 1.01;

impl Board<'_> {
    /// How many samples of the displacement in window `w` say nothing of it but that it is within a step of the encoder: all
    /// or none. Where that is so a start that is free takes up all that the step leaves, a window by its own samples
    /// would be far below the floor, and by its logarithm decide over all others. Each of them counts as what a right
    /// model leaves of a sample, besides what is seen.
    pub(super) fn mute(&self, w: usize) -> f64 {
        let window = &self.windows[w];
        let Some(seen) = &self.data.displacement else { return 0.0 };
        let values = &seen.values[window.first..window.end];
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest - least <= ONE * seen.quantum { window.len() as f64 } else { 0.0 }
    }

    /// The same of all blocks.
    pub(crate) fn mutes(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.trains.len()];
        for w in 0..self.windows.len() {
            all[self.block(w)] += self.mute(w);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use crate::board::Board;
    use identify::{
        Hold, Rig,
        fit::{Data, Seen},
    };

    /// A mass of 1 kg that Coulomb friction of 1 N holds against half of that for so long [s], and that then is pulled away by 2 N,
    /// its position seen in steps of 1 mm.
    fn held(rests: f64, duration: u32) -> (Rig, Data) {
        let rig = "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = 1.0\n[friction]\nname = \"coulomb\"\n\
            f_c = 1.0\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";
        let time: Vec<f64> = (0..200 * duration).map(|i| 0.005 * f64::from(i)).collect();
        let way = |t: f64| 0.5 * (t - rests).max(0.0).powi(2);
        let seen = time.iter().map(|t| 1e-3 * (way(*t) * 1e3).round()).collect();
        let force = time.iter().map(|t| if *t < rests { 0.5 } else { 2.0 }).collect();
        let seen = Seen::new("position", seen, 1e-3);
        (Rig::parse(rig).unwrap(), Data::driven(time, force, Hold::ZeroOrder, seen))
    }

    #[test]
    fn a_block_in_which_the_encoder_rests_counts_as_a_right_model_leaves_others() {
        let (rig, data) = held(12.0, 30);
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let (samples, mutes) = (board.samples(), board.mutes());
        let rests = samples.iter().zip(&mutes).filter(|(all, mute)| all == mute).count();
        // The window in which it breaks away begins a little before.
        assert_eq!((mutes.len(), rests), (32, 12));
        assert!(mutes[13..].iter().all(|mute| *mute == 0.0), "{mutes:?}");
        let right = board.judged(&rig, None).unwrap();
        let level = board.trained_level(&right);
        // The others leave a little less than the floor, for their starts are free.
        assert!((0.7..1.1).contains(&level), "{level} floors, many of them of rests");
        // What slides where the plant rests is seen all the same.
        let slides = Rig::parse(&rig.write().replace("f_c = 1.0", "f_c = 0.3")).unwrap();
        let level = board.trained_level(&board.judged(&slides, None).unwrap());
        assert!(level > 10.0, "{level} floors");
    }

    #[test]
    fn blocks_of_a_short_record_are_long_enough_to_tell_more_than_their_starts() {
        for (duration, blocks) in [(6, 10), (18, 30), (30, 32), (60, 40)] {
            let (rig, data) = held(1.0, duration);
            let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
            assert_eq!(board.trains.len(), blocks, "of {duration} s");
        }
    }
}
