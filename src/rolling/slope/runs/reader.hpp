// The places of a run at many times.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rolling/slope/runs/run.hpp"

namespace rolling_ellipse {

// The integrand of a part by Legendre polynomials.
using PartSeries = std::array<double, part_order>;

// The places at times of the motion after `from`. What is found out of a half turn is kept for the
// next times in it, and changes no bit of them.
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
    double half_turns_ = 0.0;  // before the one that is known
    DoubleDouble begin_;       // its time since that of the run
    double lasts_ = 0.0;       // 0 where none is known yet
    std::vector<double> panel_times_;
    std::vector<double> part_times_;
    std::size_t part_ = 0;
    PartSeries series_{};
};

}  // namespace rolling_ellipse
