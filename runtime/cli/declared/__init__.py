"""The commands of ``surefoot`` as one types them: arguments, options and help. They import little, so that
``--help`` is quick; what they do is in the modules beside this folder."""
