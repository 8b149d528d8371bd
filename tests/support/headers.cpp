// SPDX-License-Identifier: Apache-2.0
// Nothing but the headers that the build compiles once for all tests.
