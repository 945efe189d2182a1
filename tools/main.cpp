// SPDX-License-Identifier: Apache-2.0
#include "tools/program.hpp"

int main(int argc, char** argv) {
  return lacuna::tools::run(argc, argv);
}
