//! Tests of the library from outside and of the program itself, in one crate so that it is linked
//! only once.

mod architecture;
mod cli_agree;
mod cli_bad_input;
mod cli_commands;
mod cli_compare;
mod cli_help;
mod cli_kept;
mod cli_maps;
mod cli_metrics;
mod cli_model;
mod cli_page;
mod cli_paper;
mod cli_results;
mod cli_rois;
mod cli_run;
#[cfg(unix)]
mod cli_spectrum;
mod cli_validate;
mod cli_window;
mod common;
mod coordinate_dialects;
mod degenerate;
mod figures;
mod fixtures;
mod fourier_spacing;
mod froc;
mod image_reading;
mod independent_simulators;
mod learned_accuracy;
mod modality;
mod noise;
mod opencv_oracle;
mod oracle_density_recovery;
mod oracle_metrics;
mod oracle_noise;
mod oracle_samplers;
mod oracle_spatstat;
mod oversampled;
mod render;
mod ring;
mod samplers;
mod scoring;
