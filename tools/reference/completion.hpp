// SPDX-License-Identifier: Apache-2.0
// Completion of commands, options and values in a shell.
#pragma once

#include "tools/reference/command_tree.hpp"

#include <array>
#include <string>
#include <string_view>

namespace lacuna::tools {

// The endings of the files that are read, in the order of usage.md. Others are read too: formats are known by
// content.
inline constexpr std::array<std::string_view, 15> kScanEndings = {
    "ply", "las", "laz", "e57", "ptx", "pcd", "obj", "off", "stl", "xyz", "txt", "csv", "pts", "asc", "xyzn"};

// What follows an option, by the name of its value.
enum class ValueKind {
  kFree,    // nothing to complete: a number, a name to invent
  kChoice,  // one of OptionEntry::choices
  kFile,
  kFolder,
  kScan,    // a file with one of kScanEndings, or a folder
  kConfig,  // a TOML file, or the name of a config in share/lacuna/configs where the program is installed
};
ValueKind kind_of(const OptionEntry& option);

// Scripts to be sourced by the shell, or installed in its folder of completions.
std::string print_bash_completion(const CommandEntry& program);
std::string print_zsh_completion(const CommandEntry& program);
std::string print_fish_completion(const CommandEntry& program);

// "ply las laz".
std::string join(const std::vector<std::string>& words, std::string_view between = " ");
std::string scan_endings(std::string_view between);

}  // namespace lacuna::tools
