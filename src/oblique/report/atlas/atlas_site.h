// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <oblique/draw/picture/svg.h>
#include <oblique/report/atlas/agreement.h>

namespace oblique::report {

/// A file of a site.
struct SitePage {
  std::string name;  ///< "index.html"
  std::string text;
};

/// The atlas as pages that open from disk and load nothing: an index with thumbnails and filters, the table
/// of agreement and all errata, and for each programme its report.
struct AtlasSite {
  const std::vector<Programme>& programmes;
  const diagram::BlockLibrary& blocks;
  draw::Theme theme = draw::Theme::automatic;
  std::string studio = {};  ///< address of the studio's page as seen from the site; empty: none
  text::Vocabulary vocabulary = text::plain_vocabulary();
  std::function<void(double fraction)> progress = {};

  /// The index first. Throws as `DiagramReport::page` does.
  std::vector<SitePage> pages() const;
};

}  // namespace oblique::report
