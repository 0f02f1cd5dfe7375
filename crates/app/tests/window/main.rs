//! The window driven by its labels, without a display: what a reader of the screen finds is what is clicked.

mod bar;
mod blended;
mod command;
mod drawing;
mod driven;
mod dropped;
mod hands;
mod horizon;
mod keyboard;
mod layout;
mod page;
mod panel;
mod picking;
mod present;
mod share;
mod time;
mod tree;
mod unpicked;
mod volumes;
