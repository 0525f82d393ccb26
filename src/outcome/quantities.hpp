// Quantities of a motion that may pass a value.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "contact/segments.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Quantity { theta, x, z, omega, contact_x };

// Throws std::invalid_argument for a motion that is too long for a quantity, or for a function of
// which nothing is known, which is none of them.
[[noreturn]] void refuse_length(std::optional<Quantity> quantity, const std::string& requirement,
                                const std::string& got);

// The quantities at ascending times as samples have them, in SI units. The motion and the
// checkpoint have to live as long.
class Gauge {
  public:
    Gauge(const Motion& motion, const Checkpoint& checkpoint);

    std::vector<double> operator()(Quantity quantity, const std::vector<double>& times) const;

    // The length whose rounding a quantity has beside its own [m]: paths are sums.
    double rounded_length(std::optional<Quantity> quantity) const;

  private:
    void measure(Quantity quantity, const double* times, std::size_t n, double* values) const;

    const Motion& motion_;
    const Checkpoint& checkpoint_;
    Sampler sample_;
    Axes axes_;  // [m]
    bool has_coordinates_;
};

}  // namespace rolling_ellipse
