// What the generated lexer and parser, and parse/, use of ANTLR's C++ runtime.
// Takes the place of the runtime's own umbrella header, which clang rejects
// (misc/InterpreterDataReader.h holds members of types that are incomplete there). Keeps true: this
// folder comes before the runtime's on the include path.
#pragma once

// clang-format off: antlr4-common.h has to be first.
#include "antlr4-common.h"

#include "ANTLRErrorStrategy.h"
#include "CharStream.h"
#include "CommonToken.h"
#include "CommonTokenFactory.h"
#include "DefaultErrorStrategy.h"
#include "Exceptions.h"
#include "FailedPredicateException.h"
#include "InputMismatchException.h"
#include "Lexer.h"
#include "NoViableAltException.h"
#include "Parser.h"
#include "ParserRuleContext.h"
#include "RecognitionException.h"
#include "RuleContext.h"
#include "Token.h"
#include "TokenStream.h"
#include "Vocabulary.h"
#include "atn/ATN.h"
#include "atn/ATNDeserializer.h"
#include "atn/LexerATNSimulator.h"
#include "atn/ParserATNSimulator.h"
#include "atn/PredictionContext.h"
#include "dfa/DFA.h"
#include "misc/Interval.h"
#include "misc/IntervalSet.h"
#include "support/CPPUtils.h"
#include "tree/ParseTree.h"
#include "tree/TerminalNode.h"
// clang-format on
