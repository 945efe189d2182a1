// SPDX-License-Identifier: Apache-2.0
// Finds the holes of scan files and writes what `lacuna detect` writes: detect_files OUT SCAN...
#include <lacuna/lacuna.hpp>
#include <lacuna/lacuna_io.hpp>

#include <cstdio>
#include <filesystem>
#include <vector>

int main(int count, char** arguments) {
  try {
    if (count < 3) throw lacuna::Error("usage: detect_files OUT SCAN...");
    const std::filesystem::path out = arguments[1], scratch = out / "scratch";
    lacuna::io::FilesConfig config;
    config.output.report = true;
    lacuna::io::FileScan scan({arguments + 2, arguments + count}, config.input);
    std::filesystem::create_directories(scratch);
    lacuna::NoProgress silence;
    const auto found = lacuna::detect(scan, config, scratch, silence);
    lacuna::io::write_results({*found}, scan, config, out);
    std::filesystem::remove(scratch);
    std::printf("%zu loops in %s\n", found->loops.size(), out.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "detect_files: %s\n", error.what());
    return 1;
  }
}
