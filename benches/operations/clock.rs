//! Criterion with the clocks of GPU work.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode};
use shadows::wgpu;

use host::gpu::Gpu;
use host::timer::Timer;

/// Runs that a sample takes at most if they take long. Criterion asks for as many as fill its time,
/// and does not know what is done between them, which may take longer than what is timed; a sample of
/// more runs is the mean of these.
const RUNS: u64 = 50;
/// What a sample may take where more runs fit into it.
const LONG_ENOUGH: Duration = Duration::from_millis(30);

/// Runs operations by one of the clocks.
pub struct Bench<'a> {
    criterion: Criterion,
    gpu: &'a Gpu,
    timer: Timer,
}

impl<'a> Bench<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        let criterion = Criterion::default()
            .sample_size(10)
            .warm_up_time(Duration::from_millis(200))
            .measurement_time(Duration::from_secs(1))
            .without_plots();
        Self {
            criterion: criterion.configure_from_args(),
            gpu,
            timer: Timer::new(gpu),
        }
    }

    /// The clock of GPU work.
    pub fn clock(&self) -> &'static str {
        self.timer.clock().name()
    }

    pub fn finish(&mut self) {
        self.criterion.final_summary();
    }

    /// Work that gives the GPU nothing to do.
    pub fn plain<T>(&mut self, name: &str, mut work: impl FnMut() -> T) {
        self.criterion
            .bench_function(&format!("{name} [cpu]"), |b| {
                b.iter_with_large_drop(&mut work)
            });
    }

    /// The calling thread's share of work that also uploads: `work` after `before`, and neither
    /// `before` nor what the device does with the uploads counts.
    pub fn cpu<S, T>(
        &mut self,
        name: &str,
        state: &mut S,
        mut before: impl FnMut(&mut S),
        mut work: impl FnMut(&mut S) -> T,
    ) {
        let gpu = self.gpu;
        sampled(&mut self.criterion, &format!("{name} [cpu]"), || {
            before(state);
            let start = Instant::now();
            let result = black_box(work(state));
            let time = start.elapsed();
            drop(result);
            gpu.run(|_| {}); // or uploads pile up
            time
        });
    }

    /// What is recorded by `work`, after `before`, which does not count.
    pub fn gpu<S>(
        &mut self,
        name: &str,
        state: &mut S,
        mut before: impl FnMut(&mut S),
        mut work: impl FnMut(&mut S, &mut wgpu::CommandEncoder),
    ) {
        let (gpu, timer) = (self.gpu, &self.timer);
        let name = format!("{name} [{}]", self.clock());
        sampled(&mut self.criterion, &name, || {
            before(state);
            gpu.run(|_| {}); // what it uploads
            let milliseconds = timer.time(gpu, |encoder| work(state, encoder));
            Duration::from_secs_f64(1e-3 * milliseconds.max(0.0))
        });
    }
}

/// A name is its group's, a slash and its own.
fn sampled(criterion: &mut Criterion, name: &str, mut once: impl FnMut() -> Duration) {
    let (group, function) = name.split_once('/').unwrap_or((name, ""));
    let mut group = criterion.benchmark_group(group);
    group.sampling_mode(SamplingMode::Flat);
    group.bench_function(function, |b| {
        b.iter_custom(|wanted| {
            // So many at least, and on while that takes little: `--quick` asks for ever more runs
            // until their mean is steady, of which a few of a microsecond each say nothing.
            let start = Instant::now();
            let (mut runs, mut sum) = (0, Duration::ZERO);
            while runs < wanted && (runs < RUNS || start.elapsed() < LONG_ENOUGH) {
                sum += once();
                runs += 1;
            }
            sum.mul_f64(wanted as f64 / runs.max(1) as f64)
        });
    });
    group.finish();
}
