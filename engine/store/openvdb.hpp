// SPDX-License-Identifier: Apache-2.0
// OpenVDB, with the visibility that its own library has.
//
// Hidden templates would have static data apart from those of libopenvdb.so. But what the standard library
// instantiates for them, as std::call_once, is never hidden. So OpenVDB would call ours, and find its own
// data not initialised.
#pragma once

#pragma GCC visibility push(default)
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#pragma GCC visibility pop
