// Places of a run at given times.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rolling/slope/runs/run.hpp"

namespace rolling_ellipse {

// Legendre coefficients of the integrand of a part.
using PartSeries = std::array<double, part_order>;

// Reads places at times after `from`. Integrals over the current half turn are kept for the next
// times in it; the bits of an answer do not depend on earlier calls.
class RunReader {
  public:
    explicit RunReader(const SlopeRun& run);
    SlopePlace operator()(DoubleDouble time);

  private:
    bool is_well_within(double rest) const;
    double move_to(DoubleDouble since);
    double panel_time(std::size_t i);
    double part_time(std::size_t part);
    double times_in(std::size_t part, double* times) const;
    SlopePlace place_at(double rest);

    static constexpr double unknown = -1.0;

    const SlopeRun& run_;
    double half_turns_ = 0.0;  // number before the current half turn
    DoubleDouble begin_;       // time of the current half turn since `from`
    double lasts_ = 0.0;       // its duration; 0 before the first call
    std::vector<double> panel_times_;
    std::vector<double> part_times_;
    std::size_t part_ = 0;
    PartSeries series_{};
};

}  // namespace rolling_ellipse
