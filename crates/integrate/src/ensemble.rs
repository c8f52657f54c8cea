//! Many runs of one kind at once.

use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Runs `one` for each number below `count`, on so many threads, each with room of its own from `room`, and
/// hands back what it says, in order. A run that takes longer keeps one thread busy and not the others.
///
/// Which thread did what leaves no trace, so that the answers do not depend on their number.
///
/// # Errors
/// In words, if the threads cannot be started.
pub fn ensemble<S, R: Send>(
    threads: usize,
    count: usize,
    room: impl Fn() -> S + Sync + Send,
    one: impl Fn(&mut S, usize) -> R + Sync + Send,
) -> Result<Vec<R>, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|why| why.to_string())?;
    Ok(pool.install(|| (0..count).into_par_iter().map_init(room, one).collect()))
}

#[cfg(test)]
mod tests {
    use super::ensemble;

    #[test]
    fn the_answers_stand_in_order_whatever_the_threads() {
        let square = |room: &mut Vec<usize>, i: usize| {
            room.push(i);
            i * i
        };
        let one = ensemble(1, 100, Vec::new, square).unwrap();
        assert_eq!(one, ensemble(3, 100, Vec::new, square).unwrap());
        assert_eq!(one[99], 99 * 99);
    }
}
