// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/chart/chart.h>
#include <oblique/report/study/study_text.h>

namespace oblique::report {

/// A panel for each measure. Of one varied name: the measure over it, of machines that draw the median and a
/// band that holds nine tenths of them. Of none: how many machines have which value, with percentiles.
draw::Chart chart_of(const StudyResult& result);

}  // namespace oblique::report
