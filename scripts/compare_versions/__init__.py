"""The guard of a refactoring: scripts/compare-versions starts it."""
