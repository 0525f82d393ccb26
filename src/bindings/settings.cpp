#include "scene/settings.hpp"

#include "bindings/bindings.hpp"
#include "multipliers/feedback.hpp"

namespace rolling_ellipse::bindings {

void bind_settings(py::module_& m) {
    py::native_enum<Model>(m, "Model", "enum.Enum", "How the motion is described.")
        .value("AUTO", Model::automatic)
        .value("ROLLING", Model::rolling)
        .value("MULTIPLIERS", Model::multipliers)
        .value("CONTACT", Model::contact)
        .finalize();
    py::native_enum<Method>(m, "Method", "enum.Enum", "How the model is solved.")
        .value("AUTO", Method::automatic)
        .value("EXACT", Method::exact)
        .value("DOP853", Method::dop853)
        .value("DOPRI5", Method::dopri5)
        .value("RK4", Method::rk4)
        .value("GAUSS", Method::gauss)
        .value("RADAU", Method::radau)
        .finalize();
    py::native_enum<Stabilization>(m, "Stabilization", "enum.Enum", "How constraints are kept.")
        .value("NONE", Stabilization::none)
        .value("BAUMGARTE", Stabilization::baumgarte)
        .value("PROJECTION", Stabilization::projection)
        .value("PROJECTION_ENERGY", Stabilization::projection_energy)
        .value("GGL", Stabilization::ggl)
        .finalize();
    bind_class<Settings>(m, "Settings")
        .def(py::init([](Model model, Method method, double rtol, double atol,
                         std::optional<double> step, std::optional<int> stages,
                         Stabilization stabilization, std::array<double, 2> baumgarte,
                         long max_steps, long max_events, std::optional<double> rest_speed) {
                 Settings settings{};
                 settings.model = model;
                 settings.method = method;
                 settings.rtol = rtol;
                 settings.atol = atol;
                 settings.step = step;
                 settings.stages = stages;
                 settings.stabilization = stabilization;
                 settings.baumgarte_alpha = baumgarte[0];
                 settings.baumgarte_beta = baumgarte[1];
                 settings.max_steps = max_steps;
                 settings.max_events = max_events;
                 settings.rest_speed = rest_speed;
                 return settings;
             }),
             py::kw_only(), "model"_a, "method"_a, "rtol"_a, "atol"_a, "step"_a, "stages"_a,
             "stabilization"_a, "baumgarte"_a, "max_steps"_a, "max_events"_a, "rest_speed"_a);
    m.def("feedback_growth", feedback_growth, "settings"_a);
}

}  // namespace rolling_ellipse::bindings
