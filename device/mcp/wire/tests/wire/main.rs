//! The codecs of packet serial and CANopen against vectors, properties, mutations and recorded bytes of other programs.

mod canopen;
mod mutations;
mod properties;
mod python_client;
mod vectors;
