"""Tests of `pytest -m quick`: files, and single tests of slow files, from every folder.

They take a minute and find most mistakes; only the whole suite decides.
"""

QUICK = (
    "core/test_core.py::test_motions_through_python",
    "integrator/test_tableaus.py",
    "geometry/test_constraints.py::test_kinematics_against_differentiation",
    "geometry/test_ellipse.py::test_curvatures",
    "geometry/test_ellipse.py::test_support_and_its_slope",
    "scene/test_blow.py",
    "scene/test_scene.py",
    "rolling/test_flow_reference.py",
    "proof/test_certificate.py::test_a_hairs_breadth_from_the_threshold",
    "proof/test_certificate.py::test_a_fall_from_beside_the_tip_ends_where_the_law_does",
    "multipliers/test_multipliers.py",
    "contact/test_contact_reference.py",
    "outcome/test_classify.py",
    "properties/test_certificates.py::test_thresholds_grow_with_friction",
    "stability/test_singular_chart.py",
    "batches/test_simulate_many.py::test_bits_of_simulate",
    "trajectory/test_equality.py",
    "trajectory/test_sol.py",
    "trajectory/test_trajectory.py",
    "work_precision/test_results.py",
    "border/test_faces.py",
    "refusals/test_numbers.py",
    "export/test_atomic.py",
    "benchmark/test_scores.py",
    "impacts/test_laws_and_fit.py::test_stronge_and_poisson_create_no_energy",
    "report/test_errata.py",
    "pictures/test_curves.py::test_scenes_are_named_by_the_fields_that_differ",
    "pictures/test_plots.py::test_curves_over_time_are_the_trajectory",
    "pictures/test_plots.py::test_separatrix_is_between_rocking_and_rolling_over",
    "player/test_tracks.py",
    "project/test_formulas.py",
    "project/test_physics_numbers.py",
)
