//! Does the walk follow DESIGN §4.3, step by step?
