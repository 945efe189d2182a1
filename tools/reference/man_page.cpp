// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/man_page.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

namespace lacuna::tools {
namespace {

constexpr std::size_t kWidth = 78;  // of lines of the source

// Hyphens as they are typed: a plain one may become another character.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '"') {
      out += "\\(dq";
    } else {
      out += c;
    }
  }
  return out;
}

// A line that begins with a dot or an apostrophe would be a request.
std::string line_of(std::string text) {
  if (text.starts_with('.') || text.starts_with('\'')) text = "\\&" + text;
  return text + "\n";
}

std::string bold(std::string_view text) {
  return "\\fB" + escaped(text) + "\\fR";
}
std::string italic(std::string_view text) {
  return "\\fI" + escaped(text) + "\\fR";
}

// Each sentence begins a line, as troff wants it.
std::string paragraph(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string out, line;
  for (std::string word; words >> word;) {
    const std::string next = escaped(word);
    if (!line.empty() && line.size() + 1 + next.size() > kWidth) out += line_of(std::exchange(line, ""));
    line += (line.empty() ? "" : " ") + next;
    if (word.ends_with('.') || word.ends_with('?')) out += line_of(std::exchange(line, ""));
  }
  return line.empty() ? out : out + line_of(line);
}

std::string value_of(const OptionEntry& option) {
  if (option.choices.empty()) return italic(option.value);
  std::string names;
  for (const std::string& choice : option.choices) names += (names.empty() ? "" : " | ") + bold(choice);
  return names;
}

std::string entry_of(const OptionEntry& option, bool is_positional) {
  std::string out = ".TP\n";
  if (is_positional) {
    out += italic(option.names.front()) + (option.is_repeated ? " ...\n" : "\n");
  } else {
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
    out += names + (option.value.empty() ? "" : " " + value_of(option)) + "\n";
  }
  out += paragraph(option.help);
  if (!option.default_text.empty()) out += paragraph("Default: " + option.default_text);
  return out;
}

bool has_parameters(const CommandEntry& command) {
  return std::any_of(command.options.begin(), command.options.end(),
                     [](const OptionEntry& option) { return !option.section.empty(); });
}

std::string synopsis_of(const CommandEntry& command) {
  std::string line = bold(command.name) + " [" + italic("OPTION") + " ...]";
  for (const OptionEntry& positional : command.positionals) {
    line += " " + italic(positional.names.front());
    if (positional.is_repeated) line += " ...";
  }
  return line + "\n.br\n";
}

std::string describe_command(const CommandEntry& command) {
  std::string out = ".SS " + escaped(command.name) + "\n" + paragraph(command.help + ".");
  if (has_parameters(command)) out += "Takes the options of\n.B PARAMETERS\ntoo.\n";
  for (const OptionEntry& positional : command.positionals) out += entry_of(positional, true);
  for (const OptionEntry& option : command.options) {
    if (option.section.empty()) out += entry_of(option, false);
  }
  return out;
}

// Those of all commands that have any are the same: the one list of the engine.
std::string describe_parameters(const std::vector<const CommandEntry*>& commands) {
  const auto with = std::find_if(commands.begin(), commands.end(),
                                 [](const CommandEntry* command) { return has_parameters(*command); });
  if (with == commands.end()) return "";
  std::string out =
      ".SH PARAMETERS\n" +
      paragraph(
          "A config file has the same parameters: [SECTION] and key = value, with underscores in place of "
          "dashes. lacuna detect --print-config prints one.");
  std::string section;
  for (const OptionEntry& option : (*with)->options) {
    if (option.section.empty()) continue;
    if (option.section != section) out += ".SS [" + escaped(option.section) + "]\n";
    section = option.section;
    out += entry_of(option, false);
  }
  return out;
}

struct Example {
  std::string_view text, command;
};

constexpr Example kExamples[] = {
    {"The holes of a scan:", "lacuna detect scan.laz --out holes"},
    {"Only holes in which a circle of 0.2 units of the scan fits, without outer boundaries:",
     "lacuna detect scan.e57 --out holes --min-hole 0.2 --holes-only"},
    {"All tiles of an aerial survey as one scan:", "lacuna detect tiles/ --config aerial --out holes"},
    {"What a run would take:", "lacuna info scan.laz"},
};

std::string examples() {
  std::string out;
  for (const Example& example : kExamples) {
    out += out.empty() ? ".SH EXAMPLES\n" : ".PP\n";
    out += paragraph(example.text) + ".PP\n.RS 4\n.nf\n" + escaped(example.command) + "\n.fi\n.RE\n";
  }
  return out;
}

constexpr std::string_view kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
The results are complete.
.TP
.B 1
The run failed.
One line on standard error says why.
Nothing was written.
.TP
.B 2
The command line is wrong.
One line on standard error says where.
.TP
.BI "128 + " N
Signal
.I N
ended the run.
)";

constexpr std::string_view kFiles = R"(.SH FILES
.TP
.I DIR/holes.json
The loops, with their measures, point ids and coordinates.
.TP
.IR DIR/holes.csv ,\  DIR/loops.ply ,\  DIR/boundary.ply
The loops as a table, the loops as lines, and the boundary points.
.TP
.I DIR/sample.ply
Points spread evenly over the scan, up to a million, for reports and pictures.
It can be larger than a small scan.
.TP
.I DIR/report.html
With
.BR \-\-report :
the scan and its holes in 3D, for a browser.
.TP
.I DIR/run.json
Threads, tiles, times and memory of the run.
.TP
.IR PREFIX /share/lacuna/configs/*.toml
Configs that
.B \-\-config
finds by name.
)";

}  // namespace

std::string print_man_page(const CommandEntry& program, const std::string& version, const std::string& date) {
  const std::vector<const CommandEntry*> commands = all_commands(program);
  std::string page = ".TH LACUNA 1 " + date + " \"lacuna " + version + "\" \"User Commands\"\n";
  page += ".SH NAME\nlacuna \\- find holes in scanned surfaces, also in scans larger than memory\n.SH SYNOPSIS\n.nh\n";
  for (const CommandEntry* command : commands) {
    if (command->commands.empty()) page += synopsis_of(*command);
  }
  page +=
      bold(program.name) + " [" + bold("--help") + " | " + bold("--version") + "]\n.hy\n.SH DESCRIPTION\n";
  page += paragraph(
      "Lacuna reads a registered laser scan, finds the loops around its holes and its outer boundaries, and "
      "writes them with their measures. The scan may be larger than memory. Results do not depend on "
      "threads, "
      "tiles or memory. Lengths are in units of the scan.");
  page += ".PP\n" +
          paragraph(
              "Lacuna reads PLY, LAS, LAZ, E57, PTX, PCD, OBJ, OFF, STL and text. It knows formats by the "
              "first bytes of a file, not by its name.") +
          ".SH COMMANDS\n";
  for (const CommandEntry* command : commands) {
    if (command->commands.empty()) page += describe_command(*command);
  }
  page += describe_parameters(commands);
  page += kExitStatus;
  page += kFiles;
  page += examples();
  return page;
}

}  // namespace lacuna::tools
