"""The messages and services of a skin driver, as far as a bridge touches them."""
