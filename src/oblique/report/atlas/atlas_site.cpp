// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/atlas_site.h>

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/published.h>
#include <oblique/report/atlas/diagram_report.h>
#include <oblique/report/atlas/studio_link.h>
#include <oblique/report/page_text.h>

namespace oblique::report {
namespace {

constexpr double kThumbnailWidth = 300, kThumbnailHeight = 150;  // [px]
constexpr std::size_t kThumbnailPoints = 1500;                   // of a curve

constexpr std::string_view kIndexStyle = R"(<style>
  .filters { display: flex; flex-wrap: wrap; gap: .5rem 1.2rem; margin: 1rem 0 }
  .filters[hidden] { display: none }
  .filters label { display: flex; flex-direction: column; font-size: .85rem }
  .filters select { font: inherit; max-width: 13rem }
  .cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem; padding: 0 }
  .card { border: 1px solid #8886; border-radius: .4rem; padding: .6rem; text-decoration: none; overflow: hidden }
  .card:hover, .card:focus { border-color: currentColor }
  .card svg { width: 100%; height: auto; display: block }
  .card strong { display: block; line-height: 1.25; margin: .4rem 0 .2rem }
  .card span { font-size: .85rem; display: block }
  .card[hidden] { display: none }
</style>)";

/// Shows the cards that have what is chosen in every filter; a card's lists are divided by "|".
constexpr std::string_view kIndexScript = R"(<script>
  const filters = [...document.querySelectorAll('.filters select')];
  const cards = [...document.querySelectorAll('.card')];
  const count = document.getElementById('count');
  function choose() {
    let shown = 0;
    for (const card of cards) {
      const fits = filters.every((f) => f.value === '' || card.dataset[f.name].split('|').includes(f.value));
      card.hidden = !fits;
      if (fits) ++shown;
    }
    count.textContent = shown + ' of ' + cards.length + ' programmes';
  }
  for (const filter of filters) filter.addEventListener('change', choose);
  document.querySelector('.filters').hidden = false;
  choose();
</script>)";

/// What a programme is found by, for each filter; several values where it has them.
struct Facets {
  std::vector<std::string> year, author, machine, subject, elements, circuit;
};

struct Filter {
  const char* name;
  const char* label;
  std::vector<std::string> Facets::*values;
};
constexpr std::array<Filter, 6> kFilters{{{"year", "Year", &Facets::year},
                                          {"author", "Author", &Facets::author},
                                          {"machine", "Machine", &Facets::machine},
                                          {"subject", "Subject", &Facets::subject},
                                          {"elements", "Takes", &Facets::elements},
                                          {"circuit", "Circuit", &Facets::circuit}}};

/// "Open amplifier": what a block is on a real machine, else the title of its kind.
std::string element_of(const diagram::BlockDefinition& definition) {
  if (definition.role == diagram::Role::other) return definition.title;
  std::string name(diagram::role_name(definition.role));
  std::replace(name.begin(), name.end(), '-', ' ');
  return capitalised(std::move(name));
}

/// "C. Giles and B. Ulmann": each of them.
std::vector<std::string> people_of(std::string authors) {
  for (std::size_t at = authors.find(" and "); at != std::string::npos; at = authors.find(" and "))
    authors.replace(at, 5, ", ");
  std::vector<std::string> people;
  for (std::size_t begin = 0; begin <= authors.size();) {
    const std::size_t end = std::min(authors.find(", ", begin), authors.size());
    if (end > begin) people.push_back(authors.substr(begin, end - begin));
    begin = end + 2;
  }
  return people;
}

Facets facets_of(const Programme& programme, const diagram::BlockLibrary& blocks) {
  const diagram::Published& published = *programme.diagram.published;
  Facets facets;
  facets.year = {published.year ? fmt::format("{}", *published.year) : "unknown"};
  facets.author = people_of(published.author);
  const std::string& profile = programme.diagram.machine.profile;
  facets.machine = {!published.machine.empty() ? published.machine : diagram::find_machine(profile)->title};
  facets.subject = {published.subject.empty() ? "other" : published.subject};
  std::set<std::string> elements;
  const diagram::FlatDiagram flat = diagram::flatten(programme.diagram, blocks);
  for (const diagram::FlatBlock& block : flat.blocks) {
    if (block.definition->role != diagram::Role::reference) elements.insert(element_of(*block.definition));
  }
  facets.elements = {elements.begin(), elements.end()};
  facets.circuit = {published.kind == diagram::Published::Kind::equations ? "composed here" : "as patched"};
  return facets;
}

/// A chart without what is too small to read.
draw::Picture thumbnail(const Programme& programme, const diagram::BlockLibrary& blocks) {
  draw::Chart chart = plotter_chart(programme, blocks);
  chart.panels.resize(1);
  chart.width = kThumbnailWidth;
  chart.panels.front().height = kThumbnailHeight;
  for (draw::Curve& curve : chart.panels.front().curves) {
    const std::size_t step = curve.points.size() / kThumbnailPoints + 1;
    std::vector<Eigen::Vector2d> kept;
    kept.reserve(curve.points.size() / step + 1);
    for (std::size_t k = 0; k < curve.points.size(); k += step) kept.push_back(curve.points[k]);
    curve.points = std::move(kept);
  }
  draw::Picture picture = draw::draw_chart(chart);
  picture.title = programme.diagram.title;
  return picture;
}

class SiteWriter {
 public:
  explicit SiteWriter(const AtlasSite& site) : site_(site) {
    facets_.reserve(site.programmes.size());
    for (const Programme& programme : site.programmes) facets_.push_back(facets_of(programme, site.blocks));
  }

  std::vector<SitePage> write() const {
    std::vector<SitePage> pages{{"index.html", index()}};
    for (const Programme& programme : site_.programmes) {
      DiagramReport report{programme, site_.blocks, site_.vocabulary, {}, "index.html", {}};
      if (!site_.studio.empty())
        report.studio = site_.studio + studio_fragment(programme.name + ".toml", programme.text);
      pages.push_back({programme.name + ".html", report.page().text(site_.theme)});
      if (site_.progress)
        site_.progress(static_cast<double>(pages.size() - 1) / static_cast<double>(site_.programmes.size()));
    }
    return pages;
  }

 private:
  std::string index() const {
    HtmlPage page("The atlas: published analog programmes, run again");
    page.element(kIndexStyle);
    page.paragraph(
        "Each programme as it was published and patched, or composed here where only equations were "
        "published: "
        "its circuit, its settings, what its author got, and what comes out here.");
    page.paragraph(agreement_summary(site_.programmes) + ".");
    page.heading("Programmes");
    page.element(filters());
    page.element("<p id=\"count\"></p>\n<div class=\"cards\">");
    for (std::size_t k = 0; k < site_.programmes.size(); ++k) page.element(card(k));
    page.element("</div>");
    page.heading("Agreement");
    page.introduction(
        "What was published against what is computed; the difference is over the uncertainty that the author "
        "stated, or that of reading what was published, and up to 1 of it is agreement. The page of a "
        "programme says why one differs by more.");
    add_agreement(page);
    page.heading("Errata");
    page.introduction("What was found wrong in the publications.");
    for (const Programme& programme : site_.programmes) {
      const diagram::Published& published = *programme.diagram.published;
      if (published.errata.empty()) continue;
      page.subheading(diagram::citation(published));
      page.list(published.errata);
      page.link(title_of(programme), programme.name + ".html");
    }
    page.element(kIndexScript);
    return page.text(site_.theme);
  }

  void add_agreement(HtmlPage& page) const {
    const Table table = agreement_table(site_.programmes);
    const std::vector<std::vector<std::string>> rows(table.rows().begin() + 1, table.rows().end());
    if (rows.empty()) return;
    std::vector<std::string> links;
    links.reserve(rows.size());
    for (const std::vector<std::string>& row : rows) links.push_back(row.front() + ".html");
    page.table(table.rows().front(), rows, links);
  }

  static std::string title_of(const Programme& programme) {
    return programme.diagram.title.empty() ? programme.name : programme.diagram.title;
  }

  std::string filters() const {
    std::string text = "<form class=\"filters\" hidden>";
    for (const Filter& filter : kFilters) {
      std::set<std::string> values;
      for (const Facets& facets : facets_)
        values.insert((facets.*filter.values).begin(), (facets.*filter.values).end());
      text += fmt::format("\n<label>{}<select name=\"{}\"><option value=\"\">all</option>", filter.label,
                          filter.name);
      for (const std::string& value : values)
        text += fmt::format("<option>{}</option>", draw::escape_xml(value));
      text += "</select></label>";
    }
    return text + "\n</form>";
  }

  std::string card(std::size_t k) const {
    const Programme& programme = site_.programmes[k];
    const diagram::Published& published = *programme.diagram.published;
    std::string data;
    for (const Filter& filter : kFilters)
      data += fmt::format(" data-{}=\"{}\"", filter.name,
                          draw::escape_xml(fmt::format("{}", fmt::join(facets_[k].*filter.values, "|"))));
    const std::string year = published.year ? fmt::format(", {}", *published.year) : "";
    return fmt::format(R"(<a class="card" href="{}.html"{}>{}<strong>{}</strong><span>{}{}</span></a>)",
                       draw::escape_xml(programme.name), data, inline_svg(thumbnail(programme, site_.blocks)),
                       draw::escape_xml(title_of(programme)), draw::escape_xml(published.author), year);
  }

  const AtlasSite& site_;
  std::vector<Facets> facets_;
};

}  // namespace

std::vector<SitePage> AtlasSite::pages() const {
  return SiteWriter(*this).write();
}

}  // namespace oblique::report
