// SPDX-License-Identifier: MIT
// Included by every source that holds faults (faults.py).
#pragma once
#include <type_traits>
#include <utility>

extern int planted_fault;      // the one that is let loose; 0: none
extern char* planted_reached;  // a mark for each that was come by

// Whether this fault is let loose.
inline bool planted(int fault) {
  planted_reached[fault] = 1;
  return fault == planted_fault;
}

// A value by itself, whatever type of expression gives it, so that a sum and a difference are of one type.
template <class T>
auto planted_value(T&& value, int) -> typename std::decay_t<T>::PlainObject {
  return std::forward<T>(value);
}
template <class T>
auto planted_value(T&& value, long) -> std::decay_t<T> {
  return std::forward<T>(value);
}
