//! Tests of the crate through its public interface, one module per area.

mod background;
mod damage;
mod fixture;
mod folder;
mod mesh_and_views;
mod pack;
mod region;
mod round_trip;
mod storage;
