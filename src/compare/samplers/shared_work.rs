//! Work that is done once, on all cores, and whose result many threads use.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::hash::Hash;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};

/// Values by key, each computed when first asked for and then kept. If another thread is already
/// computing a value, the caller waits for it.
pub(super) struct Once<K, V> {
    /// One cell per key, which is empty until its value is computed. The lock protects the map
    /// only, so values of different keys are computed at the same time.
    cells: Mutex<HashMap<K, Arc<OnceLock<V>>>>,
}

impl<K: Eq + Hash, V: Clone> Once<K, V> {
    pub(super) fn new() -> Self {
        Self { cells: Mutex::new(HashMap::new()) }
    }

    /// Returns the value of `key`. The first call for a key computes the value with `make`.
    pub(super) fn get(&self, key: K, make: impl FnOnce() -> V) -> V {
        // a panic elsewhere cannot leave the map half changed, as every change is a single step
        let mut cells = self.cells.lock().unwrap_or_else(PoisonError::into_inner);
        let cell = Arc::clone(cells.entry(key).or_default());
        drop(cells);
        cell.get_or_init(make).clone()
    }
}

/// Separate thread pool that works while its callers sleep. Its threads are started by the first
/// call of [`Self::all`].
///
/// The caller's own pool cannot be used, for two reasons. First, a thread of that pool takes up
/// another task while it waits. That task could need the very curve that the thread is already
/// computing further down on its stack: a deadlock. Second, a sleeping thread of the caller's pool
/// cannot help with work that a sampler distributes over threads. BNOT, which computes its cells in
/// parallel, then ran on only one of two cores.
pub(super) struct Workers {
    /// Number of threads of the pool.
    threads: usize,
    /// Pool, built on first use; `None` inside if the operating system grants no more threads.
    pool: OnceLock<Option<ThreadPool>>,
}

impl Workers {
    /// Prepares a pool with as many threads as the caller's pool has.
    pub(super) fn like_the_caller() -> Self {
        Self { threads: rayon::current_num_threads(), pool: OnceLock::new() }
    }

    /// Returns the results of `task(0)` to `task(count − 1)`, in that order; `None` for a task that
    /// panicked.
    ///
    /// A task must not wait for the result of another task.
    pub(super) fn all<T, F>(&self, count: usize, task: F) -> Vec<Option<T>>
    where
        T: Send + 'static,
        F: Fn(usize) -> T + Send + Sync + 'static,
    {
        let guarded = move |k| catch_unwind(AssertUnwindSafe(|| task(k))).ok();
        let pool = self.pool.get_or_init(|| ThreadPoolBuilder::new().num_threads(self.threads).build().ok());
        let Some(pool) = pool.as_ref().filter(|_| count > 0) else {
            // the system grants no more threads: do the work on the calling thread
            return (0..count).map(guarded).collect();
        };
        let (answer, answered) = mpsc::sync_channel(1);
        pool.spawn(move || {
            let done: Vec<Option<T>> = (0..count).into_par_iter().with_max_len(1).map(guarded).collect();
            // sending fails only if the caller no longer waits
            let _ = answer.send(done);
        });
        answered.recv().unwrap_or_else(|_| (0..count).map(|_| None).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_value_is_made_once_for_all_threads() {
        let (once, made) = (Once::new(), AtomicUsize::new(0));
        let values: Vec<usize> = (0..100usize)
            .into_par_iter()
            .map(|k| {
                once.get(k % 3, || {
                    made.fetch_add(1, Ordering::Relaxed);
                    10 * (k % 3)
                })
            })
            .collect();
        assert!(values.iter().enumerate().all(|(k, v)| *v == 10 * (k % 3)));
        assert_eq!(made.into_inner(), 3);
    }

    #[test]
    fn results_come_in_order_and_a_panic_is_a_gap() {
        let workers = Workers::like_the_caller();
        let found = workers.all(50, |k| if k == 7 { panic!("on purpose") } else { k });
        assert!(found.iter().enumerate().all(|(k, v)| *v == (k != 7).then_some(k)));
        assert!(workers.all(0, |k| k).is_empty());
    }

    #[test]
    fn those_who_wait_within_a_pool_do_not_block_what_tasks_hand_out() {
        let pool = ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let sums: Vec<Vec<Option<usize>>> = pool.install(|| {
            let workers = Workers::like_the_caller();
            let sum = |k: usize| (0..1000usize).into_par_iter().map(|i| i * k).sum::<usize>();
            (0..20).into_par_iter().map(|_| workers.all(8, sum)).collect()
        });
        assert!(sums.iter().flatten().enumerate().all(|(k, sum)| *sum == Some(k % 8 * 499_500)));
    }
}
