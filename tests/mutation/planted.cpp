// SPDX-License-Identifier: MIT
// Linked to every program of a build that holds faults. OBLIQUE_PLANTED is the number of the one that is let
// loose, and OBLIQUE_PLANTED_REACHED names a file with a byte for each, which becomes 1 where it is come by:
// mapped, so that nothing is lost where a program ends by itself, and so that what it starts marks it too.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include "planted.h"

namespace {
constexpr int kMost = 4096;  // as in mutate.py
char nobody_asks[kMost];

// Before every initialiser that may hold a fault.
__attribute__((constructor(101))) void read_request() {
  if (const char* const fault = std::getenv("OBLIQUE_PLANTED")) planted_fault = std::atoi(fault);
  const char* const path = std::getenv("OBLIQUE_PLANTED_REACHED");
  if (path == nullptr) return;
  const int file = open(path, O_RDWR | O_CLOEXEC);
  void* const marks = mmap(nullptr, kMost, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (marks == MAP_FAILED) _exit(99);
  planted_reached = static_cast<char*>(marks);
  close(file);
}
}  // namespace

int planted_fault = 0;
char* planted_reached = nobody_asks;
