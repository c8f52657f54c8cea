//! duhem
