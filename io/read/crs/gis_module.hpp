// SPDX-License-Identifier: Apache-2.0
// lacuna_gis.so: the code that needs GDAL, found and loaded where it is wanted.
#pragma once

namespace lacuna::io {

// Throws `Error` if the module is neither next to the program nor in ../lib/lacuna of its folder. A library
// that holds this code may have it next to it, too, or in lib/lacuna. `user` names what needs it, such as
// "--gpkg". Cheap: loads nothing.
void check_gis_module(const char* user);

// Returns a function of the module, which stays loaded until the program ends. Throws `Error` as above, and
// if the module cannot be loaded.
void* load_gis_function(const char* name, const char* user);

// Returns the same function, or null where the module is missing or cannot be loaded.
void* find_gis_function(const char* name);

}  // namespace lacuna::io
