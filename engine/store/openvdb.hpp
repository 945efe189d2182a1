// SPDX-License-Identifier: Apache-2.0
// OpenVDB, with the visibility that its own library has.
//
// If the templates were hidden, their static data would differ from the static data of libopenvdb.so. But the
// symbols that the standard library instantiates for them, as std::call_once, are never hidden. So OpenVDB
// would call ours, and find its own data not initialised.
#pragma once

#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#pragma GCC visibility pop
