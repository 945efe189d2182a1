// SPDX-License-Identifier: Apache-2.0
// What the shared library offers to other programs. All other code has hidden visibility.
#pragma once

// Before a public function. In a class with virtual functions, and in one that is thrown, both sides also
// need one vtable and one type.
#define LACUNA_API __attribute__((visibility("default")))
