#pragma once
#include "keyblock/error.h"  // the errors of the program are those of its library
