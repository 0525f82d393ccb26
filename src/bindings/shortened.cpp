#include "bindings/shortened.hpp"

#include <structmember.h>

#include <cstddef>

namespace rolling_ellipse::bindings {
namespace {

constexpr std::size_t most_arguments = 16;

// The object that replaces the function. After its creation, only its reference count and its list
// of weak references change.
struct Shortened {
    PyObject head;
    vectorcallfunc call;
    PyObject* weak_references;
    ShortWay way;
    PyObject* function;
    std::size_t count;  // number of arguments
    PyObject* names[most_arguments];
    PyObject* defaults[most_arguments];
};

Shortened& of(PyObject* self) { return *reinterpret_cast<Shortened*>(self); }

// Names are compared by identity, since Python's compiler interns them; a call with a name that is
// not interned is passed on to the function.
PyObject* call(PyObject* self, PyObject* const* given, std::size_t flags, PyObject* named) {
    const auto& [head, own, weak, way, function, count, names, defaults] = of(self);
    const auto by_python = [&] { return PyObject_Vectorcall(function, given, flags, named); };
    if (PyVectorcall_NARGS(flags) != 1) return by_python();
    PyObject* values[most_arguments];
    std::copy_n(defaults, count, values);
    values[0] = given[0];
    const py::ssize_t others = named == nullptr ? 0 : PyTuple_GET_SIZE(named);
    for (py::ssize_t i = 0; i < others; ++i) {
        const auto place = std::find(names + 1, names + count, PyTuple_GET_ITEM(named, i)) - names;
        if (place == static_cast<py::ssize_t>(count)) return by_python();
        values[place] = given[1 + i];
    }
    if (std::find(values, values + count, nullptr) != values + count) return by_python();
    PyObject* const answer = way(values, defaults);
    return answer != nullptr ? answer : by_python();
}

// The function to which everything is passed on except calls that take the shortcut.
PyObject* asked(PyObject* self) { return of(self).function; }

PyObject* attribute(PyObject* self, PyObject* name) { return PyObject_GetAttr(asked(self), name); }

int set_attribute(PyObject* self, PyObject* name, PyObject* value) {
    return PyObject_SetAttr(asked(self), name, value);
}

// Python's `help` reads the docstring from the type, without looking up attributes.
PyObject* doc(PyObject* self, void*) { return PyObject_GetAttrString(asked(self), "__doc__"); }

PyObject* represented(PyObject* self) { return PyObject_Repr(asked(self)); }

PyObject* method(PyObject* self, PyObject* of_object, PyObject*) {
    return of_object == nullptr ? Py_NewRef(self) : PyMethod_New(self, of_object);
}

py::object make_type() {
    static PyMemberDef members[] = {
        {"__vectorcalloffset__", T_PYSSIZET, offsetof(Shortened, call), READONLY, nullptr},
        {"__weaklistoffset__", T_PYSSIZET, offsetof(Shortened, weak_references), READONLY, nullptr},
        {}};
    static PyGetSetDef properties[] = {{"__doc__", doc, nullptr, nullptr, nullptr}, {}};
    static PyType_Slot slots[] = {{Py_tp_members, members},
                                  {Py_tp_getset, properties},
                                  {Py_tp_call, reinterpret_cast<void*>(PyVectorcall_Call)},
                                  {Py_tp_getattro, reinterpret_cast<void*>(attribute)},
                                  {Py_tp_setattro, reinterpret_cast<void*>(set_attribute)},
                                  {Py_tp_repr, reinterpret_cast<void*>(represented)},
                                  {Py_tp_descr_get, reinterpret_cast<void*>(method)},
                                  {}};
    static PyType_Spec spec{"rolling_ellipse._core._Shortened", sizeof(Shortened), 0,
                            Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_VECTORCALL, slots};
    const auto type = py::reinterpret_steal<py::object>(PyType_FromSpec(&spec));
    if (!type) throw py::error_already_set();
    const py::cpp_function name([](const py::object& each) { return each.attr("__qualname__"); });
    py::module_::import("copyreg").attr("pickle")(type, name);
    return type;
}

}  // namespace

// The object and everything that it references are never freed, since it serves as a function of a
// module, which lives as long as the process.
py::object shortened(const py::function& function, ShortWay way) {
    const py::object type = make_type();
    auto* const made = PyType_GenericAlloc(reinterpret_cast<PyTypeObject*>(type.ptr()), 0);
    if (made == nullptr) throw py::error_already_set();
    Shortened& it = of(made);
    it.call = call;
    it.way = way;
    it.function = function.inc_ref().ptr();
    const py::object code = function.attr("__code__");
    const py::dict defaults = function.attr("__kwdefaults__");
    it.count = 1 + code.attr("co_kwonlyargcount").cast<std::size_t>();
    for (std::size_t k = 0; k < it.count; ++k) {
        const py::object name = code.attr("co_varnames")[py::int_(k)];
        it.names[k] = name.inc_ref().ptr();
        it.defaults[k] = Py_XNewRef(PyDict_GetItem(defaults.ptr(), name.ptr()));
    }
    return py::reinterpret_borrow<py::object>(made);
}

}  // namespace rolling_ellipse::bindings
