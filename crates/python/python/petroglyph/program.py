"""Every command of the command line as a function, with the same words and the same answers.

The functions are made of what the program says of its commands. Options have ``_`` for ``-``; an option that takes several
values takes a list, and values with commas may be tuples. The answer is the object of ``--json``. An error is a
:class:`petroglyph.PetroglyphError` with the sentence and the hint of the command line. Every function also takes `progress`,
called as ``progress(stage, done, total)``.
"""

from petroglyph._calls import commands, functions, run

_FUNCTIONS = functions()
globals().update(_FUNCTIONS)
__all__ = ["commands", "run", *_FUNCTIONS]
