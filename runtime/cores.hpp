// SPDX-License-Identifier: Apache-2.0
// How many cores this process may use.
#pragma once

#include <filesystem>
#include <string>

namespace moraine::runtime {

/// The least of the cores it is bound to and the processor time its control groups allow, rounded up; at least 1.
/// `root` stands in for the root of the file system. Cost: reads a few small files.
int usable_cores(const std::filesystem::path& root = "/");

/// The cores this process is bound to, as the operating system numbers them: "0-3,8".
std::string bound_to();

}  // namespace moraine::runtime
