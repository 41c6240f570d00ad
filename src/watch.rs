//! Long work: a bar on standard error, and Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use zeroset::raycast::Progress;

use crate::failure::Failure;

/// The work of this process.
static WORK: OnceLock<Arc<Progress>> = OnceLock::new();

/// The work that Ctrl-C stops: what is finished stays whole. A second Ctrl-C ends the process.
pub(crate) fn interruptible() -> Result<Arc<Progress>, Failure> {
    if let Some(work) = WORK.get() {
        return Ok(Arc::clone(work));
    }
    let work = Arc::clone(WORK.get_or_init(Arc::default));
    let stopped = Arc::clone(&work);
    ctrlc::set_handler(move || {
        if stopped.is_stopped() {
            std::process::exit(130);
        }
        stopped.stop();
        eprintln!("zeroset: stopping; press Ctrl-C again to stop at once");
    })
    .map_err(|error| Failure::work(format!("cannot watch for Ctrl-C: {error}")))?;
    Ok(work)
}

/// A bar on standard error; none if that is no terminal.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// An empty bar.
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{msg:32} {bar:40} {percent:>3} % {elapsed}")
            .expect("the template is valid");
        bar.set_style(style);
        Self(bar)
    }

    /// Shows what is being done, and how much of it, from 0 to 1.
    pub(crate) fn show(&self, what: &str, share: f64) {
        if self.0.message() != what {
            self.0.set_message(what.to_owned());
        }
        self.0.set_position((1000.0 * share.clamp(0.0, 1.0)) as u64);
    }

    /// Shows `progress` over `rays` rays while `work` is done.
    pub(crate) fn follow<T>(
        &self,
        what: &str,
        rays: usize,
        progress: &Progress,
        work: impl FnOnce() -> T,
    ) -> T {
        let start = progress.done();
        let finished = AtomicBool::new(false);
        std::thread::scope(|scope| {
            let watcher = scope.spawn(|| {
                while !finished.load(Ordering::Relaxed) {
                    let done = progress.done().saturating_sub(start);
                    self.show(what, done as f64 / rays.max(1) as f64);
                    std::thread::park_timeout(Duration::from_millis(100));
                }
            });
            let done = work();
            finished.store(true, Ordering::Relaxed);
            watcher.thread().unpark();
            done
        })
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
