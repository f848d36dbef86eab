#!/bin/sh
# Takes out of an environment what no service needs at run time: slim.sh SITE_PACKAGES
set -eu
cd "$1"

# Mend takes one robot of the many described, neither PyBullet's samples nor its OpenGL, and brings
# a language model of its own to PocketSphinx.
find cmeel.prefix/share/example-robot-data/robots -mindepth 1 -maxdepth 1 \
    ! -name pr2_description -exec rm -r {} +
rm -r pybullet_data pybullet_envs eglRenderer*.so pocketsphinx/model/en-us/*.lm.bin

# Of SciPy, what neither Mend nor the rest of SciPy that it loads imports.
(cd scipy && rm -r cluster datasets differentiate fftpack integrate io misc odr signal stats)

# What only compilers and tests read.
rm -r cmeel.prefix/include cmeel.prefix/bin cmeel.prefix/share/cmake cmeel.prefix/share/doc
find cmeel.prefix/lib -name '*.a' -delete
find numba numpy scipy -type d -name tests -prune -exec rm -r {} +
find . -name '*.pyi' -delete

# Of the C++ libraries those that Python's modules load, under the one name that they are loaded by:
# a wheel has a copy for each of a library's names.
modules=$(find cmeel.prefix/lib/python3* -name '*_pywrap*.so')
[ -n "$modules" ]
needed=$(ldd $modules | sed -n 's|^[[:space:]]*\([^ ]*\) => .*/cmeel\.prefix/.*|\1|p' | sort -u)
[ -n "$needed" ]
for library in cmeel.prefix/lib/lib*.so*; do
    echo "$needed" | grep -qxF "${library##*/}" || rm "$library"
done

# Debugging symbols; libraries whose paths a wheel's maker has patched do not survive losing them.
find pybullet*.so cmeel.prefix llvmlite uvloop -name '*.so*' -type f -exec strip --strip-unneeded {} +
