//! `compare` as a program: its command line, what it writes, and the advice it gives.

mod args;
mod cli;
mod sweep;
