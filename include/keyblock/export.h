#pragma once

/// Marks what the shared library shows. Everything else of it is hidden.
#define KEYBLOCK_API __attribute__((visibility("default")))

/// Marks what a shown class keeps to itself.
#define KEYBLOCK_HIDDEN __attribute__((visibility("hidden")))
