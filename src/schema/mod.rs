//! What host and device share.

pub mod layout;
