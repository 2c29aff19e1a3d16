// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/text_width.h>

#include <array>

// Advance widths of DejaVu Sans, in thousandths of the font's size. It is the widest of the fonts that a
// reader of our pictures is likely to have, a sixth wider than Helvetica: what fits in it fits everywhere.

namespace oblique::draw {
namespace {

/// From ' ' to '~'.
constexpr std::array<short, 95> kAscii{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
/// From 'А' to 'я'.
constexpr std::array<short, 64> kCyrillic{684, 686, 686, 610, 781,  632, 1077, 641, 748, 748, 710, 752,  863,
                                          752, 787, 752, 603, 698,  611, 609,  861, 685, 776, 686, 1069, 1094,
                                          833, 882, 686, 698, 1080, 695, 613,  617, 589, 525, 691, 615,  901,
                                          532, 650, 650, 604, 639,  754, 654,  612, 654, 635, 550, 583,  592,
                                          855, 592, 681, 591, 915,  942, 707,  790, 589, 549, 842, 602};
/// Greek capitals are as wide as this in the mean; small letters, other than ω, are narrower.
constexpr int kLetter = 690, kOmega = 837, kSign = 838, kRaised = 401, kDot = 318, kBroad = 1000;
/// Bold letters against regular ones, in the mean; single ones are up to a quarter wider.
constexpr double kBold = 1.15;

int advance(char32_t c) {
  if (c < 0x20 || (c >= 0x300 && c < 0x370)) return 0;  // combining marks
  if (c < 0x7F) return kAscii[c - 0x20];
  if (c >= 0x410 && c < 0x450) return kCyrillic[c - 0x410];
  switch (c) {
    case U'°':
    case U'²':
    case U'³':
    case U'¹':
      return kRaised;
    case U'·':
    case U'′':
      return kDot;
    case U'±':
    case U'×':
    case U'÷':
      return kSign;
    case U'ω':
      return kOmega;
    case U'…':
    case U'—':
      return kBroad;
    default:
      break;
  }
  if (c >= 0x2070 && c < 0x20A0) return kRaised;  // subscripts and superscripts
  if (c >= 0x2190 && c < 0x2300) return kSign;    // arrows and operators
  return c < 0x2E80 ? kLetter : kBroad;
}

/// The letter that starts at `at`, which moves behind it; broken UTF-8 gives the replacement character.
char32_t next_letter(const std::string& text, std::size_t& at) {
  const auto head = static_cast<unsigned char>(text[at++]);
  if (head < 0x80) return head;
  int more = head >= 0xF0 ? 3 : head >= 0xE0 ? 2 : head >= 0xC0 ? 1 : 0;
  if (more == 0) return U'\uFFFD';
  char32_t letter = head & (0x3FU >> static_cast<unsigned>(more));
  for (; more > 0; --more) {
    if (at == text.size() || (static_cast<unsigned char>(text[at]) & 0xC0U) != 0x80U) return U'\uFFFD';
    letter = (letter << 6U) | (static_cast<unsigned char>(text[at++]) & 0x3FU);
  }
  return letter;
}

}  // namespace

double text_width(const std::string& text, double size, bool bold) {
  double thousandths = 0;
  for (std::size_t at = 0; at < text.size();) thousandths += advance(next_letter(text, at));
  return thousandths / 1000 * size * (bold ? kBold : 1);
}

}  // namespace oblique::draw
