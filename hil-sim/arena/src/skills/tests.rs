//! Do tries succeed and fail by what truly happens, and come out the same each time?
