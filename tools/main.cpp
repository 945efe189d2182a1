#include "tools/program.hpp"

int main(int argc, char** argv) {
  return lacuna::run(argc, argv);
}
