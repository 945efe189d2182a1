// SPDX-License-Identifier: Apache-2.0
// Finds the holes of scan files and writes what `lacuna detect` writes: detect_files OUT SCAN...
#include <lacuna/lacuna.hpp>
#include <lacuna/lacuna_io.hpp>

#include <cstdio>
#include <vector>

int main(int count, char** arguments) {
  try {
    if (count < 3) throw lacuna::Error("usage: detect_files OUT SCAN...");
    lacuna::io::FilesConfig config;
    config.output.report = true;
    const lacuna::io::ScanFiles scan({arguments + 2, arguments + count}, config.input);
    lacuna::io::ScanPass pass(scan);
    lacuna::io::ResultFolder out(arguments[1]);
    lacuna::NoProgress silence;
    const auto found = lacuna::detect(pass, config, out.temporary(), silence);
    lacuna::io::write_results({*found, pass.counts()}, scan, config, out);
    std::printf("%zu loops in %s\n", found->loops.size(), out.path().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "detect_files: %s\n", error.what());
    return 1;
  }
}
