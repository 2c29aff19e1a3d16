// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/printed_sum.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace oblique::report {
namespace {

/// Short products first and numbers last; none with a minus at the head of a sum, if another can be there.
void put_in_reading_order(std::vector<Monomial>& terms) {
  const auto rank = [](const Monomial& term) {
    const std::size_t n = term.factors.size() + term.divisors.size();
    return std::pair(n == 0 ? std::numeric_limits<std::size_t>::max() : n, std::signbit(term.coefficient));
  };
  std::stable_sort(terms.begin(), terms.end(),
                   [&](const Monomial& a, const Monomial& b) { return rank(a) < rank(b); });
  const auto plus = std::find_if(terms.begin(), terms.end(),
                                 [](const Monomial& term) { return !std::signbit(term.coefficient); });
  if (plus != terms.end()) std::rotate(terms.begin(), plus, plus + 1);
}

std::string product_text(const std::vector<std::string>& factors) {
  std::string text;
  std::set<std::string> done;
  for (const std::string& factor : factors) {
    if (!done.insert(factor).second) continue;
    const auto times = std::count(factors.begin(), factors.end(), factor);
    const bool is_power = factor.find('^') != std::string::npos;  // x^3^2 is x^9
    text += (text.empty() ? "" : "*") +
            (times == 1 ? factor : fmt::format(fmt::runtime(is_power ? "({})^{}" : "{}^{}"), factor, times));
  }
  return text;
}

}  // namespace

std::vector<Monomial> merged(std::vector<Monomial> terms) {
  std::vector<Monomial> kept;
  std::map<std::pair<std::vector<std::string>, std::vector<std::string>>, std::size_t> places;
  for (Monomial& term : terms) {
    auto key = std::pair(term.factors, term.divisors);
    std::sort(key.first.begin(), key.first.end());
    std::sort(key.second.begin(), key.second.end());
    const auto [place, is_new] = places.emplace(std::move(key), kept.size());
    if (is_new) {
      kept.push_back(std::move(term));
    } else {
      kept[place->second].coefficient += term.coefficient;
    }
  }
  std::erase_if(kept, [](const Monomial& term) { return term.coefficient == 0; });
  put_in_reading_order(kept);
  return kept;
}

std::string sum_text(const std::vector<Monomial>& terms, int digits) {
  if (terms.empty()) return "0";
  std::string text;
  for (const Monomial& term : terms) {
    const bool minus = std::signbit(term.coefficient);
    text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
    const std::string size = number_text(std::abs(term.coefficient), digits);
    const std::string product = product_text(term.factors);
    if (product.empty() || size != "1") text += size;
    if (!product.empty()) text.append(size == "1" ? "" : "*").append(product);
    if (term.divisors.size() == 1) text += "/" + term.divisors.front();
    if (term.divisors.size() > 1) text += "/(" + product_text(term.divisors) + ")";
  }
  return text;
}

std::string number_text(double value, int digits) {
  return fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits);
}

}  // namespace oblique::report
