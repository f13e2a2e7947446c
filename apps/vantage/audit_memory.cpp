// SPDX-License-Identifier: Apache-2.0
#include "audit_memory.h"

#include <fstream>
#include <string>

namespace {

/// A line of /proc/self/status, which is in KiB [MiB].
double status(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    double kilobytes = 0.0;
    if (word == key && file >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

}  // namespace

PeakMemory::PeakMemory() : before_(status("VmRSS:")) { std::ofstream("/proc/self/clear_refs") << 5; }

double PeakMemory::peak() const { return status("VmHWM:"); }
