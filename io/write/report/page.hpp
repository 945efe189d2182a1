// SPDX-License-Identifier: Apache-2.0
// The page of io/write/report/page with its style, its scripts and three.js in it, put together by the build.
#pragma once

#include <string_view>

namespace lacuna::io {

extern const std::string_view kReportPage;
inline constexpr std::string_view kDataPlace = "<!--{data}-->\n";  // where a report's data go

}  // namespace lacuna::io
