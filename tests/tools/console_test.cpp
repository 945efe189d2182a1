// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine.hpp"
#include "engine/run/words.hpp"
#include "tests/support/test.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/progress.hpp"
#include "tools/console/terminal.hpp"

namespace lacuna::tools {
namespace {

TEST_CASE("durations read as a person would say them, counts have separators and sizes units") {
  CHECK(print_duration(0.004) == "0.00 s");
  CHECK(print_duration(9.994) == "9.99 s");
  CHECK(print_duration(12.34) == "12.3 s");
  CHECK(print_duration(59.96) == "1:00 min");
  CHECK(print_duration(187) == "3:07 min");
  CHECK(print_duration(3723) == "1:02:03 h");
  CHECK(print_count(0) == "0");
  CHECK(print_count(999) == "999");
  CHECK(print_count(1'234'567) == "1,234,567");
  CHECK(print_size(1023) == "1023 bytes");
  CHECK(print_size(1536) == "1.5 KiB");
  CHECK(print_size(512ull << 20) == "512 MiB");
}

TEST_CASE("lengths and shares have three digits, and the unit where there is one") {
  CHECK(print_length(2.2834, "m") == "2.28 m");
  CHECK(print_length(2.2834, "") == "2.28");
  CHECK(print_length(0, "m") == "0.00 m");
  CHECK(print_length(0.0123456, "") == "0.0123");
  CHECK(print_length(9.996, "") == "10.0");
  CHECK(print_length(99.96, "") == "100");
  CHECK(print_length(999.6, "") == "1,000");
  CHECK(print_length(7033.2, "ft") == "7,033 ft");
  CHECK(print_length(1.5e-7, "") == "1.5e-07");
  CHECK(print_length(2.5e9, "") == "2,500,000,000");
  CHECK(print_area(3.974, "m") == "3.97 m²");
  CHECK(print_share(0.8734) == "87.3 %");
  CHECK(print_share(1) == "100 %");
  CHECK(print_share(0) == "0.00 %");
}

TEST_CASE("places of one scan have as many decimals, by its extent") {
  CHECK(print_place({1.23456, -0.001, 2}, 9.5) == "1.23 0.00 2.00");
  CHECK(print_place({500123.456, 12.3, 2}, 900) == "500123 12 2");
  CHECK(print_place({1, 2, 3}, 0) == "1.00 2.00 3.00");
  CHECK(print_place({0.0512345, 0, 0}, 0.05) == "0.0512 0.0000 0.0000");
}

using namespace std::string_literals;

TEST_CASE("control characters are shown, not obeyed") {
  CHECK(visible("\033]0;pwned\a") == "\\u001b]0;pwned\\u0007");
  CHECK(visible("a\tb\nc\rd\177"s) == "a\\u0009b\\u000ac\\u000dd\\u007f");
  CHECK(visible("\0"s) == "\\u0000");
  CHECK(visible("\xc2\x9b"
                "2J \xc2\x80 \xc2\x9f") == "\\u009b2J \\u0080 \\u009f");
  CHECK(visible("\x9b"
                "2J") == "\\x9b2J");  // C1 as one byte
}

TEST_CASE("a long line keeps its begin and its end, and no character is cut") {
  CHECK(shortened("a.ply: short") == "a.ply: short");
  for (const std::string unit : {"x", "ö", "点", "\xf0\x9f\x95\xb3"}) {
    std::string text = "a.json: ";
    while (text.size() < 1'000'000) text += unit;
    const std::string line = shortened(text + ": is not allowed");
    CHECK(line.size() < 1000);
    CHECK(line.starts_with("a.json: " + unit));
    CHECK(line.ends_with(unit + ": is not allowed"));
    CHECK(visible(line) == line);
  }
}

TEST_CASE("bytes that are not UTF-8 are shown one by one, and the next character is found") {
  CHECK(visible("a\xff"
                "b") == "a\\xffb");
  CHECK(visible("\xe7\x82") == "\\xe7\\x82");  // cut
  CHECK(visible("\xe7\x82"
                "x") == "\\xe7\\x82x");
  CHECK(visible("\xc0\x9b") == "\\xc0\\x9b");  // overlong
  CHECK(visible("\xe0\x82\x9b") == "\\xe0\\x82\\x9b");
  CHECK(visible("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // a surrogate
  CHECK(visible("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // above U+10FFFF
}

StepProgress evaluating() {
  return {.step = "evaluate", .done = 3'200'000, .total = 8'000'000, .step_seconds = 2, .run_seconds = 75};
}

TEST_CASE("a line of progress has the step, its share, speed and time left, and the time of the run") {
  StepProgress progress = evaluating();
  CHECK(progress_text(progress) == "evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 1:15 min");
  CHECK(progress_bar(progress, 100) ==
        "lacuna  [====      ]  evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 1:15 min");
  CHECK(progress_bar(progress, 20) == "lacuna  [====      ");
  progress.total = 0;
  CHECK(progress_text(progress) == "evaluate: 1.60 M points/s; run: 1:15 min");
  progress.done = 0;
  CHECK(progress_text(progress) == "evaluate; run: 1:15 min");
  progress.total = 100;
  CHECK(progress_text(progress) == "evaluate: 0 %; run: 1:15 min");
}

TEST_CASE("the share of the run and its time left follow the step, and the bar is the run's") {
  StepProgress progress = evaluating();
  progress.run_share = 0.25;
  CHECK(*progress.run_seconds_left() == Approx(225));
  CHECK(progress_text(progress) ==
        "evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 25 %, 1:15 min, 3:45 min left");
  CHECK_THAT(progress_bar(progress, 100), StartsWith("lacuna  [==        ]  evaluate: 40 %"));
  CHECK(progress_json(progress) ==
        R"({"step": "evaluate", "share": 0.400, "seconds": 2.000, "seconds_left": 3.000, "points": 3200000, )"
        R"("run_share": 0.250, "run_seconds": 75.000, "run_seconds_left": 225.000})");
  progress = {.step = "nest"};
  CHECK(progress_json(progress) ==
        R"({"step": "nest", "share": null, "seconds": 0.000, "seconds_left": null, "points": 0, )"
        R"("run_share": null, "run_seconds": 0.000, "run_seconds_left": null})");
}

TEST_CASE("a run goes from 0 to 1 through its steps, whether they count points or not") {
  Config config;
  for (const double resolution : {0.0, 0.5}) {
    config.scale.resolution = resolution;
    const RunSteps steps = steps_of_run(config);
    CHECK(run_share(steps, steps.front(), 0) == 0.0);
    CHECK(*run_share(steps, steps.back(), 1) == Approx(1));
    for (std::size_t i = 1; i < steps.size(); ++i) {
      CHECK(*run_share(steps, steps[i], 0) == Approx(*run_share(steps, steps[i - 1], 1)));
      CHECK(*run_share(steps, steps[i], 0) <= *run_share(steps, steps[i], 1));
    }
  }
  CHECK(*run_share(steps_of_check(), "voids", 0) == Approx(0.8));
  CHECK_FALSE(run_share(steps_of_check(), "evaluate", 0));
  CHECK_FALSE(run_share({}, "evaluate", 0));
}

TEST_CASE("a counted run knows its step, its points and its share, and a step that has ended is whole") {
  CountedProgress progress(steps_of_check());
  CHECK(progress.state().step.empty());
  progress.begin("area", 100);
  progress.advance(30);
  progress.advance(20);
  CHECK(progress.state().step == "area");
  CHECK(progress.state().done == 50);
  CHECK(*progress.state().run_share == Approx(0.4));
  progress.begin("voids", 0);
  CHECK(*progress.state().run_share == Approx(0.8));
  progress.end();
  CHECK(*progress.state().share() == 1);
  CHECK(*progress.state().run_share == Approx(1));
}

TEST_CASE("the time left of a step follows from its share and its time") {
  StepProgress progress = evaluating();
  progress.done = 9'000'000;  // counts beyond the total do not exceed the step
  CHECK(*progress.share() == 1);
  CHECK(*progress.seconds_left() == 0);
  progress.done = 0;
  CHECK(*progress.share() == 0);
  CHECK_FALSE(progress.seconds_left());
  progress.total = 0;
  CHECK_FALSE(progress.share());
}

TEST_CASE("the progress bar is shorter than the terminal is wide, whatever it shows") {
  for (std::size_t width = 0; width < 200; ++width) {
    for (const std::uint64_t done : {0ull, 1ull, 1000ull, ~0ull}) {
      for (const double seconds : {0.0, 1e-9, 100.0, 1e12}) {
        const StepProgress progress{.step = "a step with a long name",
                                    .done = done,
                                    .total = 1000,
                                    .step_seconds = seconds,
                                    .run_seconds = seconds};
        REQUIRE(progress_bar(progress, width).size() <= (width > 0 ? width - 1 : 0));
      }
    }
  }
}

}  // namespace

}  // namespace lacuna::tools
