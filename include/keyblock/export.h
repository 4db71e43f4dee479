#pragma once

/// Marks what the shared library shows. Everything else of it is hidden.
#define KEYBLOCK_API __attribute__((visibility("default")))
