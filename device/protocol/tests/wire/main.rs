//! Codecs of both protocols against vectors, properties, mutations and recorded bytes of other programs.

mod canopen;
mod motion_mind;
mod mutations;
mod properties;
mod python_client;
mod vectors;
