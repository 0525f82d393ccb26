#include "scene/settings.hpp"

#include <algorithm>

#include "bindings/bindings.hpp"
#include "multipliers/steps.hpp"

namespace rolling_ellipse::bindings {
namespace {

// Reads a setting; a choice is given by its name.
template <class Value>
void take(py::handle given, Value& value) {
    if constexpr (std::is_enum_v<Value>) {
        const auto& known = names<Value>;
        const auto at = std::find(known.begin(), known.end(), given.cast<std::string>());
        value = static_cast<Value>(at - known.begin());
    } else {
        value = given.cast<Value>();
    }
}

Settings settings_of(const py::dict& fields) {
    Settings settings{};
    std::apply([&](const auto&... each) { (take(fields[each.first], settings.*each.second), ...); },
               settings_fields);
    return settings;
}

}  // namespace

void bind_settings(py::module_& m) {
    m.attr("MODELS") = py::tuple(py::cast(names<Model>));
    m.attr("METHODS") = py::tuple(py::cast(names<Method>));
    m.attr("STABILIZATIONS") = py::tuple(py::cast(names<Stabilization>));
    bind_class<Settings>(m, "Settings").def(py::init(&settings_of), "fields"_a);
    m.def("feedback_growth", feedback_growth, "settings"_a);
}

}  // namespace rolling_ellipse::bindings
