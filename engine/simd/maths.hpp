// SPDX-License-Identifier: Apache-2.0
// The functions of maths-inl.hpp for one number. They give the same bytes. Code outside of kernels uses them
// in place of the C library's.
#pragma once

namespace lacuna {

double exponential(double x);         // exp(x) for -600 <= x <= 0, to 1e-14; 0 from -700 down
double angle_of(double y, double x);  // atan2(y, x), to 2 units in the last place; (0, 0) gives 0
double cosine(double x);              // of 0 <= x <= pi / 2, to 2e-16

}  // namespace lacuna
