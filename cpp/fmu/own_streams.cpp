/// \file
/// The linker puts these in the place of stdout and stderr, which an archive that was compiled for
/// programs takes from where no library has them. ODE says nothing there: start_ode() sees to it.

#include <cstdio>

extern "C" {
extern std::FILE *__real_stdout, *__real_stderr;
std::FILE *__wrap_stdout = __real_stdout, *__wrap_stderr = __real_stderr;
}
