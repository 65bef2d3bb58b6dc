"""Models and worlds: files, xacro, XML, overrides and built-in resources."""
